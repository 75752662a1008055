// tmcl sim: a virtual module for other programs to talk to.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/motion_state.hpp"
#include "apps/tmcl/scenario_source.hpp"
#include "apps/tmcl/sim_introduction.hpp"
#include "apps/tmcl/sim_plan.hpp"
#include "apps/tmcl/status_line.hpp"
#include "apps/tmcl/trace_file.hpp"
#include "boards/twin/paced_port.hpp"
#include "scenario/section.hpp"
#include "server/control.hpp"
#include "server/control_server.hpp"
#include "server/kept_eeprom.hpp"
#include "server/live_simulation.hpp"
#include "server/module_setup.hpp"
#include "server/port_kinds.hpp"
#include "server/session.hpp"
#include "server/signal_recording.hpp"

namespace opentmcl::app {

namespace asio = boost::asio;
using client::Error;
using client::ErrorKind;
using client::Result;
using scenario::Report;
using server::Session;
using server::SessionSetup;
using server::SignalRecording;

namespace {

/// Said in place of a path.
constexpr const char* no_control = "none";

std::vector<std::string> machine_kinds() {
  std::vector<std::string> names;
  scenario::for_each_machine_kind(
      [&names](const scenario::MachineKind& kind, auto, const auto&) { names.emplace_back(kind.name); });
  return names;
}

std::vector<std::string> motor_names() {
  const std::vector<std::string_view> names = scenario::motor_names();
  return {names.begin(), names.end()};
}

/// Where the slider of a stage stands, from the middle of its travel; nothing for a free shaft.
std::string describe_machine(const twin::World& world) {
  constexpr double micrometres = 1000.0;  // in 1 mm
  if (world.machine().place_unit() != twin::PlaceUnit::micrometre) return {};
  return fmt::format("  {:7.2f} mm", static_cast<double>(world.machine().place()) / micrometres);
}

/// Shows what the module does, now and from then on.
class LiveDisplay {
 public:
  LiveDisplay(asio::io_context& events, server::LiveSimulation& simulation, Session& session)
      : timer_(events), simulation_(simulation), session_(session) {
    refresh();
  }

 private:
  void refresh() {
    simulation_.serve(std::chrono::steady_clock::now());
    VirtualModule& module = session_.module();
    status_.show(describe(motion_state_of(module)) + describe_machine(module.world()));
    timer_.expires_after(status_.period());
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) refresh();
    });
  }

  asio::steady_timer timer_;
  server::LiveSimulation& simulation_;
  Session& session_;
  StatusLine status_;
};

/// Where the session is logged: to be replayed, and so that the control interface can save it.
Session::MakeLog log_for(const SimOptions& options) {
  using server::SessionLog;
  if (!options.log.empty()) {
    return [path = options.log](const SessionSetup& setup) { return SessionLog::create(path, setup); };
  }
  if (options.control == no_control || !options.replay.empty()) return {};
  return [](const SessionSetup& setup) { return SessionLog::create_nameless(setup); };
}

/// What is written down of a session: what comes from outside, signals, everything that happens in the world.
struct Records {
  std::unique_ptr<SignalRecording> recording;  ///< nullptr: none
  std::unique_ptr<TraceFile> trace;            ///< nullptr: none

  static Result<Records> open(const SimOptions& options, const SimPlan& plan) {
    Records records;
    if (!plan.recording.file.empty()) {
      const twin::World world(nullptr, plan.scenario.mounted(*plan.scenario.module));
      Result<std::unique_ptr<SignalRecording>> recording = SignalRecording::create(plan.recording, world);
      if (!recording) return recording.error();
      records.recording = std::move(*recording);
    }
    if (!options.trace.empty()) {
      Result<std::unique_ptr<TraceFile>> trace = TraceFile::create(options.trace);
      if (!trace) return trace.error();
      records.trace = std::move(*trace);
    }
    return records;
  }

  /// @param ended called when the scenario has come to its end
  Session::Options session_options(const Context& context, const SimOptions& options,
                                   std::function<void()> ended) const {
    return {log_for(options), trace.get(), recording.get(),
            [json = context.json, ended = std::move(ended)](const SessionSetup& setup, const Report& what) {
              if (!setup.scenario.empty()) print_report(what, setup.scenario_name, json);
              if (what.kind == Report::Kind::end) ended();
            }};
  }
};

/// A session at these doors, new or from a snapshot.
Result<std::unique_ptr<Session>> open_session(const SimOptions& options, const SessionSetup& setup,
                                              Session::Doors doors, const Session::Options& session_options) {
  if (options.load.empty()) return Session::start(setup, std::move(doors), session_options);
  Result<std::unique_ptr<Session>> session = Session::resume(options.load, std::move(doors), session_options);
  if (session && !(*session)->setup().has_same_doors(setup)) {
    return Error{
        ErrorKind::usage,
        options.load + " is of a module with other ports: --port-kind, --tcp, --wire and CAN have to be as they were",
        {}};
  }
  return session;
}

/// Beside the link unless the user says where; nothing if that is not possible or not wanted.
Result<std::optional<server::ControlServer>> listen_for_control(asio::io_context& events, const SimOptions& options,
                                                                const std::string& link, server::Control& control) {
  std::optional<server::ControlServer> server;
  if (options.control == no_control) return server;
  const bool is_usual = options.control.empty();
  Result<server::ControlServer> listening =
      server::ControlServer::listen(events, is_usual ? server::control_path_of(link) : options.control, control);
  if (listening) {
    server.emplace(std::move(*listening));
  } else if (is_usual) {
    fmt::print(stderr, "tmcl: no control interface: {}\n", listening.error().message);
  } else {
    return listening.error();
  }
  return server;
}

/// The first of two outcomes that is an error.
Result<void> first_error(const Result<void>& first, const Result<void>& second) {
  return first.ok() ? second : first;
}

Result<void> log_outcome(const SimOptions& options, const Session& session) {
  const std::optional<Error> failure = session.log_failure();
  return failure && !options.log.empty() ? Result<void>(*failure) : Result<void>();
}

Result<void> scenario_outcome(const Session& session) {
  const std::size_t failures = session.failures();
  if (failures == 0) return {};
  return Error{
      ErrorKind::refused,
      fmt::format("{}: {} expectation{} failed", session.setup().scenario_name, failures, failures == 1 ? "" : "s"),
      {}};
}

/// Ends the session and all that is written down of it; nothing of what happens afterwards is in it.
Result<void> finish(const SimOptions& options, Session& session, const Records& records) {
  const Result<void> recorded = session.finish();
  const Result<void> traced = records.trace ? records.trace->finish() : Result<void>();
  return first_error(first_error(recorded, traced),
                     first_error(log_outcome(options, session), scenario_outcome(session)));
}

/// Does what a log says once more, as fast as it goes.
Result<void> replay(const Context& context, const SimOptions& options, const Records& records) {
  const Result<std::unique_ptr<Session>> session =
      Session::resume(options.replay, {}, records.session_options(context, options, [] {}));
  if (!session) return session.error();
  Result<void> finished = finish(options, **session, records);
  const Microseconds time = (*session)->module().now();
  if (context.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"time", time}, {"same", true}}.dump());
  } else {
    fmt::print("Replayed {:.6f} s, the same as then.\n", static_cast<double>(time) / 1e6);
  }
  return finished;
}

Result<void> simulate(const Context& context, const SimOptions& options, SimPlan& plan, const Records& records) {
  SessionSetup& setup = plan.setup;
  const ModuleDescription& description = *setup.module;
  std::unique_ptr<server::KeptEeprom> eeprom;
  if (!options.eeprom.empty()) {
    Result<std::unique_ptr<server::KeptEeprom>> opened = server::KeptEeprom::open(options.eeprom, description);
    if (!opened) return opened.error();
    eeprom = std::move(*opened);
    const Result<EepromFile::Image> image = eeprom->load(setup.eeprom);
    if (!image) return image.error();
    setup.eeprom = *image;
  }

  // This thread is the only one: nothing needs a lock.
  asio::io_context events(BOOST_ASIO_CONCURRENCY_HINT_UNSAFE);
  std::optional<server::LiveSimulation> simulation;
  Result<SimEndpoints> endpoints = SimEndpoints::open(events, options.endpoints, description,
                                                      [&simulation](server::WallTime now) { simulation->serve(now); });
  if (!endpoints) return endpoints.error();
  setup.ports.clear();
  Session::Doors doors;
  for (const hal::Port& port : endpoints->ports()) {
    setup.ports.push_back({port.kind, options.wire});
    doors.ports.push_back(port.bytes);
  }
  server::MemoryLine line;  // for the program
  setup.ports.push_back({hal::PortKind::usb});
  doors.ports.push_back(&line.port());
  doors.can = endpoints->can_port();
  setup.has_can = doors.can != nullptr;

  // Who hears of the module finds it started, and on its CAN bus.
  const auto stop = [&simulation] {
    if (simulation) simulation->stop();
  };
  Result<std::unique_ptr<Session>> opened =
      open_session(options, setup, std::move(doors), records.session_options(context, options, stop));
  if (!opened) return opened.error();
  Session& session = **opened;
  if (!plan.program.empty()) {
    Result<void> loaded = server::load_program(session.module(), line, *setup.module, plan.program, !options.no_start);
    if (!loaded) return loaded;
  }

  std::vector<const server::RequestQueue*> requests = endpoints->requests();
  requests.push_back(&line.port());
  server::LiveSimulation::Options pace{plan.speed, std::nullopt};
  if (plan.duration != 0) pace.duration = plan.duration;
  simulation.emplace(events, session.module(), requests, pace);
  server::Control control(session, *simulation);
  control.when_loaded([&eeprom] {
    if (eeprom) eeprom->note_exchange();
  });
  const Result<std::optional<server::ControlServer>> control_server =
      listen_for_control(events, options, endpoints->link_path(), control);
  if (!control_server) return control_server.error();
  Result<void> outcome;
  simulation->after_turn([&] {
    session.check_now_and_then();
    outcome = log_outcome(options, session);
    if (eeprom && outcome) outcome = eeprom->save(session.module());
    if (!outcome) simulation->stop();
  });
  asio::signal_set signals(events, SIGINT, SIGTERM, SIGHUP);
  signals.async_wait([&simulation](const boost::system::error_code& error, int) {
    if (!error) simulation->stop();
  });
  introduce(context, description, *endpoints, *control_server ? (*control_server)->path() : "");
  if (!session.has_begun()) session.begin(plan.duration);
  simulation->start();
  std::optional<LiveDisplay> display;
  if (!options.quiet) display.emplace(events, *simulation, session);
  simulation->run();
  display.reset();
  const Result<void> finished = finish(options, session, records);
  if (eeprom && outcome) outcome = eeprom->finish(session.module());
  return first_error(outcome, finished);
}

Result<void> run_sim(const Context& context, const SimOptions& options) {
  Result<SimPlan> plan = SimPlan::of(options);
  if (!plan) return plan.error();
  const Result<Records> records = Records::open(options, *plan);
  if (!records) return records.error();
  return options.replay.empty() ? simulate(context, options, *plan, *records) : replay(context, options, *records);
}

}  // namespace

void add_sim(CLI::App& app, Context& context) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command = app.add_subcommand("sim", "a virtual module on a serial port, a TCP port and CAN")->fallthrough();
  command->footer(
      "Examples:\n  tmcl sim\n  tmcl sim tmcm1110 --program my.tmc --eeprom my.eeprom\n"
      "  tmcl sim --speed max --duration 10min --program my.tmc");
  CLI::Option* module =
      command->add_option("MODULE", options->module, "pd1161 or tmcm1110; default: what the program says, else pd1161");
  command->add_option("--pty-link", options->endpoints.link,
                      "where to make a link to the serial port; default: tmcl-MODULE in $XDG_RUNTIME_DIR or /tmp");
  command->add_option(
      "--tcp", options->endpoints.tcp,
      fmt::format("PORT, ADDRESS:PORT or none; default: {} on this machine, or a free port if that is taken",
                  SimEndpoints::default_tcp_port));
  command
      ->add_option("--port-kind", options->endpoints.port_kind,
                   fmt::format("what the serial port stands for: {}; of a {}: {}", server::port_kind_choice(tmcm1110),
                               pd1161.argument, server::port_kind_choice(pd1161)))
      ->capture_default_str();
  command
      ->add_option("--wire", options->wire,
                   "bit/s of the serial port and of TCP: bytes take their time; without it they take none")
      ->check(CLI::Range(PacedPort::slowest_rate, PacedPort::fastest_rate));
  command->add_option("--slcan-link", options->endpoints.slcan_link,
                      "tmcm1110: where to make a link to a serial CAN adapter (SLCAN)");
  command->add_option("--can-udp", options->endpoints.can_udp,
                      "tmcm1110: GROUP:PORT of a UDP multicast CAN bus in python-can's format, on this machine only");
  command->add_option("--can", options->endpoints.can, "tmcm1110: CAN interface of Linux, as vcan0");
  command->add_option("--speed", options->speed, "times real time, or max")->capture_default_str();
  command->add_option("--duration", options->duration, "end after this much of the module's time: 5s, 500ms, 2min");
  CLI::Option* eeprom =
      command->add_option("--eeprom", options->eeprom, "keep the EEPROM in this file; made if it does not exist");
  CLI::Option* program = command->add_option("--program", options->program, "load this TMCL program and start it");
  add_assembler_options(*command, options->assembler);
  CLI::Option* machine =
      command
          ->add_option("--machine", options->machine,
                       "what the motor turns: a linear stage of 100 mm with its switches, a table behind a gear with a "
                       "home mark, or a free shaft without end")
          ->check(CLI::IsMember(machine_kinds()))
          ->capture_default_str();
  CLI::Option* motor =
      command->add_option("--motor", options->motor, "instead of the module's own; ideal: one that loses no step")
          ->check(CLI::IsMember(motor_names()));
  command->add_option("--control", options->control,
                      "socket for tmcl sim ctl, or none; default: the link's path and .control");
  CLI::Option* scenario =
      command
          ->add_option("--scenario", options->scenario,
                       "module, machine and what happens to them, from this file; the other options go before it")
          ->excludes(module)
          ->excludes(machine)
          ->excludes(motor);
  command->add_option("--record", options->record, "write down signals: a file that ends in .vcd or .csv");
  command->add_option("--signals", options->signals, "names of them, with commas: position,stage")->delimiter(',');
  command->add_option("--record-every", options->record_every,
                      "how often signals are looked at that are not in the trace; default: 1ms");
  command->add_option("--log", options->log, "write down all that comes from outside, to be replayed");
  command->add_option("--trace", options->trace, "write down every signal of the world, as text");
  CLI::Option* load = command->add_option("--load", options->load, "go on from this snapshot of tmcl sim ctl save");
  CLI::Option* replay = command->add_option("--replay", options->replay,
                                            "do once more what this log says, check that it is the same, and end");
  replay->excludes(load);
  // A log says with what it began.
  for (CLI::Option* option : {module, eeprom, program, machine, motor, scenario}) {
    load->excludes(option);
    replay->excludes(option);
  }
  command->add_flag("--no-start", options->no_start, "do not start the program");
  command->add_flag("-q,--quiet", options->quiet, "no live line");
  add_sim_ctl(*command, context);
  command->callback([&context, options, command] {
    if (command->get_subcommands().empty()) context.finish(run_sim(context, *options));
  });
}

}  // namespace opentmcl::app
