// tmcl run: assemble a program, load it into a module, start it and follow it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/tmcl/assembler_choice.hpp"
#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/interruption.hpp"
#include "apps/tmcl/motion_state.hpp"
#include "apps/tmcl/quantity.hpp"
#include "apps/tmcl/source_program.hpp"
#include "apps/tmcl/status_line.hpp"
#include "client/program_transfer.hpp"

namespace opentmcl::app {

using client::Client;
using client::Error;
using client::ErrorKind;
using client::ProgramStatus;
using client::Result;

namespace {

struct RunOptions {
  std::string file;
  std::string module;
  std::string duration;
  AssemblerChoice assembler;
  bool quiet = false;
};

/// How the program ended, or did not.
struct Outcome {
  ProgramStatus program;
  std::int32_t position = 0;
};

/// Shows how far a transfer is, and ends it on Ctrl-C.
client::Progress progress(StatusLine& line, const Interruption& interruption, const char* what) {
  return [&line, &interruption, what](std::size_t done, std::size_t total) {
    if (line.is_terminal()) line.show(fmt::format("{} {} of {} instructions", what, done, total));
    return !interruption.requested();
  };
}

Result<std::int32_t> get_into(Client& client, AxisParameter parameter, std::int32_t& value) {
  Result<std::int32_t> read = client.axis_parameter(parameter);
  if (read.ok()) value = *read;
  return read;
}

Result<MotionState> read_state(Client& client) {
  MotionState state;
  const std::pair<AxisParameter, std::int32_t*> values[] = {
      {AxisParameter::actual_position, &state.position},
      {AxisParameter::actual_speed, &state.velocity},
      {AxisParameter::microstep_resolution, &state.microstep_resolution},
      {AxisParameter::pulse_divisor, &state.pulse_divisor}};
  for (const auto& [parameter, value] : values) {
    if (const auto read = get_into(client, parameter, *value); !read) return read.error();
  }
  return state;
}

/// Stops program and motor.
Error interrupt(Client& client) {
  if (Result<void> stopped = client.stop_program(); !stopped) return stopped.error();
  if (Result<void> stopped = client.stop(); !stopped) return stopped.error();
  return {ErrorKind::interrupted, "interrupted; program and motor have been stopped", {}};
}

/// @param limit on the module's clock
Result<Outcome> follow(Client& client, StatusLine& line, const Interruption& interruption, bool quiet,
                       std::optional<client::Duration> limit) {
  const client::Duration begin = client.transport().now();
  auto next_line = std::chrono::steady_clock::now();
  while (true) {
    const Result<ProgramStatus> status = client.program_status();
    if (!status) return status.error();
    const bool ended = status->state == ProgramStatus::State::stopped;
    const auto now = std::chrono::steady_clock::now();
    // By the clock of the one who reads the lines: a virtual module may be thousands of times faster.
    if (ended || (!quiet && now >= next_line)) {
      Result<MotionState> state = read_state(client);
      if (!state) return state.error();
      state->program = status->state;
      if (!quiet) line.show(describe(*state));
      if (ended) return Outcome{*status, state->position};
      next_line = now + line.period();
    }
    if (interruption.requested()) return interrupt(client);
    if (limit && client.transport().now() - begin >= *limit) {
      const Error stopped = interrupt(client);
      if (stopped.kind != ErrorKind::interrupted) return stopped;
      const Result<std::int32_t> position = client.axis_parameter(AxisParameter::actual_position);
      if (!position) return position.error();
      return Outcome{*status, *position};
    }
    client.transport().pause(std::chrono::milliseconds(50));
  }
}

/// To the module at the port. Without a port, to a virtual one of the kind the source is for; a port has to lead to
/// that kind, unless the user says for which module the source is assembled.
Result<Connection> connect_for(const Context& context, const RunOptions& options, const std::string& source) {
  if (!options.module.empty()) return context.connect();
  const Result<const ModuleDescription*> wanted = module_named_by(options.file, source);
  if (!wanted) return wanted.error();
  if (*wanted == nullptr) return context.connect();
  if (context.port == Context().port) {
    Context of_source = context;
    of_source.port = fmt::format("sim:{}", (*wanted)->argument);
    return of_source.connect();
  }
  Result<Connection> connection = context.connect();
  if (!connection) return connection;
  const Result<const ModuleDescription*> found = module_of(*connection->client);
  if (!found) return found.error();
  if (*found == *wanted) return connection;
  return Error{ErrorKind::bad_file,
               fmt::format("{} is for a {}, and at {} is a {}; --module {} loads it all the same", options.file,
                           (*wanted)->name, context.port, (*found)->name, (*found)->argument),
               {}};
}

Result<void> run_run(const Context& context, const RunOptions& options) {
  std::optional<client::Duration> limit;
  if (!options.duration.empty()) {
    const Result<Microseconds> duration = parse_duration(options.duration);
    if (!duration) return duration.error();
    limit = client::Duration(*duration);
  }
  Result<std::string> text = read_source(options.file);
  if (!text) return text.error();
  const Result<Connection> connection = connect_for(context, options, *text);
  if (!connection) return connection.error();
  Client& client = *connection->client;
  const Result<const ModuleDescription*> module = chosen_module(options.module, client);
  if (!module) return module.error();
  const Result<lang::AssemblyResult> assembled =
      assemble_text(options.file, std::move(*text), assembler_options(options.assembler, **module));
  if (!assembled) return assembled.error();
  const std::vector<Command>& commands = assembled->program->commands;
  const std::vector<Command> image = client::with_end_mark(commands, (*module)->program_capacity);

  const Interruption interruption;
  StatusLine line;
  if (Result<void> loaded = client::download(client, image, 0, progress(line, interruption, "loaded")); !loaded) {
    return loaded;
  }
  if (Result<void> verified = client::verify(client, image, 0, progress(line, interruption, "verified")); !verified) {
    return verified;
  }
  if (Result<void> started = client.start_program(); !started) return started;
  const Result<Outcome> outcome = follow(client, line, interruption, options.quiet, limit);
  line.end();
  if (!outcome) return outcome.error();
  if (context.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"instructions", commands.size()},
                                              {"program", name_of(outcome->program.state)},
                                              {"address", outcome->program.program_counter},
                                              {"position", outcome->position}}
                           .dump());
  } else {
    fmt::print("program {} at address {}, position {}\n", name_of(outcome->program.state),
               outcome->program.program_counter, outcome->position);
  }
  return {};
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "load a TMCL program into a module and follow it")->fallthrough();
  command->footer(
      "Examples:\n  tmcl run my.tmc                       in a virtual module, as fast as possible\n"
      "  tmcl --port /dev/ttyACM0 run my.tmc   in a real one\n\nCtrl-C stops the program and the motor.");
  command->add_option("FILE", options->file, "TMCL source; - for standard input")->required();
  command->add_option("--module", options->module,
                      "pd1161 or tmcm1110; default: what the module says it is, which has to be what FILE says");
  command->add_option("--duration", options->duration, "stop program and motor after this time: 5s, 500ms");
  add_assembler_options(*command, options->assembler);
  command->add_flag("-q,--quiet", options->quiet, "show no state");
  command->callback([&context, options] { context.finish(run_run(context, *options)); });
}

}  // namespace opentmcl::app
