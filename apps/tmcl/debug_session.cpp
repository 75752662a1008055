#include "apps/tmcl/debug_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "apps/tmcl/scenario_source.hpp"
#include "apps/tmcl/source_program.hpp"
#include "client/port_address.hpp"
#include "debug/module_target.hpp"
#include "debug/twin/twin_target.hpp"
#include "lang/file_provider.hpp"
#include "lang/module_comment.hpp"
#include "scenario/scenario_file.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

std::string count_of_errors(const std::string& path, std::size_t count) {
  return fmt::format("{} has {} error{}", path, count, count == 1 ? "" : "s");
}

Result<scenario::Scenario> read_bench(const std::string& path, const DebugListeners& listeners) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  scenario::ScenarioFile file = scenario::read_scenario(*text);
  if (file.scenario) return *std::move(file.scenario);
  listeners.diagnostics(scenario::format(file.problems, path));
  return Error{ErrorKind::bad_file, count_of_errors(path, file.problems.size()), {}};
}

Result<debug::Program> assembled(const std::string& path, const DebugRequest& request, const ModuleDescription& module,
                                 const DebugListeners& listeners) {
  Result<std::string> text = read_source(path);
  if (!text) return text.error();
  const lang::AssemblerOptions options = assembler_options(request.assembler, module);
  lang::DiskFiles files;
  lang::AssemblyResult result = lang::assemble(path, *std::move(text), options, files);
  if (!result.diagnostics.empty()) listeners.diagnostics(lang::format(result.diagnostics, result.sources));
  if (result.program) return debug::Program(std::move(result), module);
  const auto errors = std::count_if(result.diagnostics.begin(), result.diagnostics.end(), [](const auto& diagnostic) {
    return diagnostic.severity() == lang::Severity::error;
  });
  return Error{ErrorKind::bad_file, count_of_errors(path, static_cast<std::size_t>(errors)), {}};
}

/// The program in a module up to its end: what a download ends with, or memory that was never written.
Result<debug::Program> read_out(client::Client& client, const ModuleDescription& module,
                                const client::Progress& progress) {
  constexpr std::uint8_t end_marker = 0;
  constexpr std::uint8_t erased = 0xFF;
  std::vector<Command> commands;
  while (commands.size() < module.program_capacity) {
    const Result<Command> command = client::read_instruction(client, static_cast<std::uint16_t>(commands.size()));
    if (!command) return command.error();
    if (command->opcode == end_marker || command->opcode == erased) break;
    commands.push_back(*command);
    if (!progress(commands.size(), module.program_capacity)) return Error{ErrorKind::interrupted, "interrupted", {}};
  }
  if (!commands.empty()) return debug::Program::disassembled(std::move(commands), module, "disassembly");
  return Error{ErrorKind::refused,
               "the module shows no program: it has none, or code protection (global parameter 81) hides it; name the "
               "source",
               {}};
}

/// The module of a port sim:NAME; nullptr for any other port.
Result<const ModuleDescription*> simulated_module(const Context& context) {
  const Result<client::PortAddress> port = client::parse_port_address(context.port);
  if (!port) return port.error();
  const auto* const simulated = std::get_if<client::SimulatedAddress>(&*port);
  if (simulated == nullptr) return nullptr;
  return named_module(simulated->module);
}

/// The module that a source says it is for; nullptr if it says none. Error: bad_file.
Result<const ModuleDescription*> module_of_comment(const std::string& path) {
  const Result<std::string> text = read_source(path);
  if (!text) return text.error();
  const std::optional<lang::ModuleComment> comment = lang::module_named_in(*text);
  if (!comment) return nullptr;
  if (comment->module != nullptr) return comment->module;
  return Error{ErrorKind::bad_file,
               fmt::format("{} is for a module \"{}\", which is not known here", path, comment->written),
               {}};
}

/// The twin to make: what the user says, else what the scenario or else the source says, else what the port says. A
/// port that was typed has to agree with all of them.
Result<const ModuleDescription*> module_of_twin(const Context& context, const DebugRequest& request,
                                                const ModuleDescription* by_port,
                                                const std::optional<scenario::Scenario>& bench,
                                                const std::string& path) {
  const ModuleDescription* wanted = bench ? bench->module : nullptr;
  std::string who = request.scenario;
  if (!request.module.empty()) {
    Result<const ModuleDescription*> named = named_module(request.module);
    if (!named) return named;
    wanted = *named;
    if (bench && bench->module != wanted) {
      return Error{
          ErrorKind::usage,
          fmt::format("{} is for a {}, but a {} is asked for", request.scenario, bench->module->name, wanted->name),
          {}};
    }
  }
  if (wanted == nullptr) {
    Result<const ModuleDescription*> by_source = module_of_comment(path);
    if (!by_source) return by_source;
    wanted = *by_source;
    who = path;
  }
  const bool port_was_typed = context.port != Context().port;
  if (wanted == nullptr || (port_was_typed && wanted == by_port)) return by_port;
  if (!port_was_typed) return wanted;
  const std::string wish = request.module.empty() ? fmt::format("{} is for a {}", who, wanted->name)
                                                  : fmt::format("a {} is asked for", wanted->name);
  return Error{ErrorKind::usage, fmt::format("{}, but the port {} is a {}", wish, context.port, by_port->name), {}};
}

Result<DebugSession> open_twin(const Context& context, const DebugRequest& request, const DebugListeners& listeners,
                               const ModuleDescription* by_port) {
  std::optional<scenario::Scenario> bench;
  std::string path = request.file;
  if (!request.scenario.empty()) {
    Result<scenario::Scenario> read = read_bench(request.scenario, listeners);
    if (!read) return read.error();
    bench = *std::move(read);
    if (path.empty()) path = program_path(*bench, request.scenario);
  }
  if (path.empty()) {
    return Error{
        ErrorKind::usage, "a twin begins without a program: name the source of one, or a scenario with one", {}};
  }
  const Result<const ModuleDescription*> module = module_of_twin(context, request, by_port, bench, path);
  if (!module) return module.error();
  Result<debug::Program> program = assembled(path, request, **module, listeners);
  if (!program) return program.error();
  debug::TwinSetup setup;
  if (bench) setup.scenario = *std::move(bench);
  setup.scenario.module = *module;
  DebugSession session;
  session.program.emplace(std::move(*program));
  session.target = std::make_unique<debug::TwinTarget>(std::move(setup), listeners.reports);
  session.scenario = request.scenario;
  return session;
}

Result<DebugSession> open_module(const Context& context, const DebugRequest& request, const DebugListeners& listeners,
                                 const client::Progress& progress) {
  if (!request.scenario.empty()) {
    return Error{ErrorKind::usage, "a scenario is the bench of a twin (port sim:pd1161), not of a module", {}};
  }
  Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  DebugSession session;
  session.connection = std::move(*connection);
  client::Client& client = *session.connection.client;
  const Result<const ModuleDescription*> module = chosen_module(request.module, client);
  if (!module) return module.error();
  Result<debug::Program> program = request.file.empty() ? read_out(client, **module, progress)
                                                        : assembled(request.file, request, **module, listeners);
  if (!program) return program.error();
  session.program.emplace(std::move(*program));
  session.target = std::make_unique<debug::ModuleTarget>(client, **module);
  return session;
}

/// Where the program in the module departs from the source.
Error another_program(debug::Engine& engine, const debug::MemoryComparison& comparison, const LoadingAdvice& advice) {
  const debug::Program& program = engine.program();
  const std::uint16_t address = comparison.differing.front();
  const Result<Command> found = client::read_instruction(engine.target().client(), address);
  if (!found) return found.error();
  const auto line = program.line_of(address);
  const std::string place =
      line ? fmt::format("{}:{}", program.file_name(line->file), line->line) : fmt::format("address {}", address);
  return {
      ErrorKind::bad_file,
      fmt::format("{}: the module has another program: {} of {} instructions differ, the first at address {}, where "
                  "it has `{}` and the source `{}`; {}",
                  place, comparison.differing.size(), program.size(), address, program.text_of(*found),
                  program.text_of(program.commands()[address]), advice.to_load),
      {}};
}

Error hidden_program(const LoadingAdvice& advice) {
  return {ErrorKind::refused,
          fmt::format("the module's program is protected against reading (global parameter 81), so nobody can tell "
                      "whether it is the one of the source; {} takes that on trust, and `tmcl set --global 0 81 0` "
                      "erases it and lifts the protection",
                      advice.to_trust),
          {}};
}

Result<std::string> attach(debug::Engine& engine) {
  const Result<debug::Stop> found = engine.attach();
  if (!found) return found.error();
  return fmt::format("the program {} at {}", engine.is_running() ? "runs" : "stands",
                     engine.program().name_of(found->address));
}

}  // namespace

Result<DebugSession> open_debug_session(const Context& context, const DebugRequest& request,
                                        const DebugListeners& listeners, const client::Progress& progress) {
  if (request.file == standard_input) {
    return Error{ErrorKind::usage, "standard input has the debugger's commands: name a file with the source", {}};
  }
  const Result<const ModuleDescription*> simulated = simulated_module(context);
  if (!simulated) return simulated.error();
  if (*simulated != nullptr) return open_twin(context, request, listeners, *simulated);
  return open_module(context, request, listeners, progress);
}

Result<std::string> load_program(debug::Engine& engine, Loading loading, const LoadingAdvice& advice,
                                 const client::Progress& progress) {
  if (loading == Loading::trust) return attach(engine);
  Result<debug::MemoryComparison> comparison = engine.compare(progress);
  if (!comparison) return comparison.error();
  if (loading == Loading::attach) {
    if (!comparison->readable) return hidden_program(advice);
    if (!comparison->is_same()) return another_program(engine, *comparison, advice);
    return attach(engine);
  }
  std::string done = "the module has this program already";
  if (!comparison->is_loaded()) {
    if (!comparison->readable && !comparison->writable) return hidden_program(advice);
    const Result<std::size_t> sent = engine.download(*comparison, progress);
    if (!sent) return sent.error();
    if (*sent > 0) done = fmt::format("sent {} of {} instructions", *sent, engine.program().size());
    if (comparison->readable) {
      comparison = engine.compare(progress);
      if (!comparison) return comparison.error();
      if (!comparison->is_same()) {
        return Error{ErrorKind::protocol,
                     fmt::format("the program did not arrive: the instruction at address {} is another one",
                                 comparison->differing.front()),
                     {}};
      }
    }
  }
  const Result<debug::Stop> stop = engine.restart();
  if (!stop) return stop.error();
  return done;
}

}  // namespace opentmcl::app
