// tmcl sim: a virtual module for other programs to talk to.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/tmcl/bench_session.hpp"
#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/motion_state.hpp"
#include "apps/tmcl/quantity.hpp"
#include "apps/tmcl/sim_endpoints.hpp"
#include "apps/tmcl/source_program.hpp"
#include "apps/tmcl/status_line.hpp"
#include "boards/twin/virtual_module.hpp"
#include "scenario/section.hpp"
#include "server/kept_eeprom.hpp"
#include "server/live_simulation.hpp"
#include "server/module_setup.hpp"

namespace opentmcl::app {

namespace asio = boost::asio;
using client::Result;

namespace {

struct SimOptions {
  std::string module = pd1161.argument;
  SimEndpoints::Options endpoints;
  std::string speed = "1";
  std::string duration;
  std::string eeprom;
  std::string program;
  std::string machine = "stage";
  std::string motor;
  BenchSession::Options bench;
  bool no_start = false;
  bool quiet = false;
};

void introduce_as_json(const ModuleDescription& module, const SimEndpoints& endpoints) {
  fmt::print("{}\n", nlohmann::ordered_json{{"module", module.name},
                                            {"pty", endpoints.pty_path()},
                                            {"link", endpoints.link_path()},
                                            {"port_kind", name_of(endpoints.port_kind())},
                                            {"tcp", endpoints.tcp_url()},
                                            {"slcan", endpoints.slcan_path()},
                                            {"slcan_link", endpoints.slcan_link_path()},
                                            {"can_udp", endpoints.can_udp_url()},
                                            {"can", endpoints.can_interface()}}
                         .dump());
}

void introduce_as_text(const ModuleDescription& module, const SimEndpoints& endpoints) {
  fmt::print("Virtual {}, firmware V{}.{:02}. Talk to it at\n", module.name, module.firmware_major,
             module.firmware_minor);
  fmt::print("  {}  (serial port as {}, a link to {})\n", endpoints.link_path(), name_of(endpoints.port_kind()),
             endpoints.pty_path());
  const auto name = [](const std::string& endpoint, const std::string& remark) {
    if (!endpoint.empty()) fmt::print("  {}{}\n", endpoint, remark);
  };
  name(endpoints.tcp_url(), "");
  name(endpoints.slcan_link_path(), fmt::format("  (CAN over SLCAN, a link to {})", endpoints.slcan_path()));
  name(endpoints.can_udp_url(), "  (CAN over UDP multicast as python-can does it)");
  name(endpoints.can_interface(), "  (CAN interface)");
  fmt::print("Ctrl-C ends it.\n");
}

void introduce(const Context& context, const ModuleDescription& module, const SimEndpoints& endpoints) {
  if (context.json) {
    introduce_as_json(module, endpoints);
  } else {
    introduce_as_text(module, endpoints);
  }
  std::fflush(stdout);
}

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
  LiveDisplay(asio::io_context& events, server::LiveSimulation& simulation, VirtualModule& module)
      : timer_(events), simulation_(simulation), module_(module) {
    refresh();
  }

 private:
  void refresh() {
    simulation_.serve(std::chrono::steady_clock::now());
    status_.show(describe(motion_state_of(module_)) + describe_machine(module_.world()));
    timer_.expires_after(status_.period());
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) refresh();
    });
  }

  asio::steady_timer timer_;
  server::LiveSimulation& simulation_;
  VirtualModule& module_;
  StatusLine status_;
};

Result<void> run_sim(const Context& context, const SimOptions& options) {
  BenchSession::Options bench_options = options.bench;
  bench_options.json = context.json;
  Result<std::unique_ptr<BenchSession>> opened_bench = BenchSession::open(bench_options);
  if (!opened_bench) return opened_bench.error();
  BenchSession& bench = **opened_bench;
  scenario::Scenario& scenario = bench.scenario();
  if (!bench.has_scenario()) {
    const Result<const ModuleDescription*> found = named_module(options.module);
    if (!found) return found.error();
    scenario.module = *found;
    scenario::for_each_machine_kind([&](const scenario::MachineKind& kind, auto, const auto& dimensions) {
      if (kind.name == options.machine) scenario.machine = dimensions;
    });
    if (options.motor == scenario::ideal_motor) scenario.motor = std::nullopt;
    if (const twin::MotorData* const motor = twin::find_motor(options.motor)) scenario.motor = *motor;
  }
  const ModuleDescription& description = *scenario.module;
  const Result<double> speed = parse_speed(options.speed);
  if (!speed) return speed.error();
  server::LiveSimulation::Options pace{*speed, std::nullopt};
  if (!options.duration.empty()) {
    const Result<Microseconds> duration = parse_duration(options.duration);
    if (!duration) return duration.error();
    pace.duration = *duration;
  }
  if (pace.duration) scenario.duration = *pace.duration;
  if (scenario.duration != 0) pace.duration = scenario.duration;
  std::vector<Command> commands;
  const std::string& program = options.program.empty() ? scenario.program : options.program;
  if (!program.empty()) {
    lang::AssemblerOptions assembler;
    assembler.module = &description;
    const Result<lang::AssemblyResult> assembled = assemble_file(program, assembler);
    if (!assembled) return assembled.error();
    commands = assembled->program->commands;
  }
  if (Result<void> prepared = bench.prepare_recording(); !prepared) return prepared;
  std::unique_ptr<server::KeptEeprom> eeprom;
  if (!options.eeprom.empty()) {
    Result<std::unique_ptr<server::KeptEeprom>> opened = server::KeptEeprom::open(options.eeprom, description);
    if (!opened) return opened.error();
    eeprom = std::move(*opened);
  }

  // This thread is the only one: nothing needs a lock.
  asio::io_context events(BOOST_ASIO_CONCURRENCY_HINT_UNSAFE);
  std::optional<server::LiveSimulation> simulation;
  Result<SimEndpoints> endpoints = SimEndpoints::open(events, options.endpoints, description,
                                                      [&simulation](server::WallTime now) { simulation->serve(now); });
  if (!endpoints) return endpoints.error();
  server::MemoryLine line;
  std::vector<const server::RequestQueue*> requests = endpoints->requests();
  requests.push_back(&line.port());
  std::vector<hal::Port> ports = endpoints->ports();
  ports.push_back({&line.port(), hal::PortKind::usb});

  VirtualModule::Options board = scenario.board();
  board.can = endpoints->can_port();
  VirtualModule module(description, ports, board, bench.observer());
  endpoints->connect(module);
  bench.prepare(module);
  if (eeprom) {
    if (Result<void> loaded = eeprom->load(module); !loaded) return loaded;
  }
  // Who hears of the module finds it started, and on its CAN bus.
  module.advance_to(module.now());
  if (!commands.empty()) {
    if (Result<void> loaded = server::load_program(module, line, commands, !options.no_start); !loaded) return loaded;
  }

  simulation.emplace(events, module, requests, pace);
  Result<void> outcome;
  if (eeprom) {
    simulation->after_turn([&] {
      if (Result<void> saved = eeprom->save(module); !saved) {
        outcome = saved;
        simulation->stop();
      }
    });
  }
  asio::signal_set signals(events, SIGINT, SIGTERM, SIGHUP);
  signals.async_wait([&simulation](const boost::system::error_code& error, int) {
    if (!error) simulation->stop();
  });
  introduce(context, description, *endpoints);
  bench.start(module, [&simulation] { simulation->stop(); });
  simulation->start();
  std::optional<LiveDisplay> display;
  if (!options.quiet) display.emplace(events, *simulation, module);
  simulation->run();
  display.reset();
  Result<void> finished = bench.finish(module);
  if (!outcome) return outcome;
  if (eeprom) {
    if (Result<void> saved = eeprom->finish(module); !saved) return saved;
  }
  return finished;
}

}  // namespace

void add_sim(CLI::App& app, Context& context) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command = app.add_subcommand("sim", "a virtual module on a serial port, a TCP port and CAN")->fallthrough();
  command->footer(
      "Examples:\n  tmcl sim\n  tmcl sim tmcm1110 --program my.tmc --eeprom my.eeprom\n"
      "  tmcl sim --speed max --duration 10min --program my.tmc");
  CLI::Option* module = command->add_option("MODULE", options->module, "pd1161 or tmcm1110")->capture_default_str();
  command->add_option("--pty-link", options->endpoints.link,
                      "where to make a link to the serial port; default: tmcl-MODULE in $XDG_RUNTIME_DIR or /tmp");
  command->add_option(
      "--tcp", options->endpoints.tcp,
      fmt::format("PORT, ADDRESS:PORT or none; default: {} on this machine, or a free port if that is taken",
                  SimEndpoints::default_tcp_port));
  command
      ->add_option("--port-kind", options->endpoints.port_kind,
                   "what the serial port stands for: usb, rs485, or rs232 (pd1161)")
      ->capture_default_str();
  command
      ->add_option("--wire", options->endpoints.wire,
                   "bit/s of the serial port and of TCP: bytes take their time; without it they take none")
      ->check(CLI::Range(300U, 1'000'000U));
  command->add_option("--slcan-link", options->endpoints.slcan_link,
                      "tmcm1110: where to make a link to a serial CAN adapter (SLCAN)");
  command->add_option("--can-udp", options->endpoints.can_udp,
                      "tmcm1110: GROUP:PORT of a UDP multicast CAN bus in python-can's format, on this machine only");
  command->add_option("--can", options->endpoints.can, "tmcm1110: CAN interface of Linux, as vcan0");
  command->add_option("--speed", options->speed, "times real time, or max")->capture_default_str();
  command->add_option("--duration", options->duration, "end after this much of the module's time: 5s, 500ms, 2min");
  command->add_option("--eeprom", options->eeprom, "keep the EEPROM in this file; made if it does not exist");
  command->add_option("--program", options->program, "load this TMCL program and start it");
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
  command
      ->add_option("--scenario", options->bench.scenario,
                   "module, machine and what happens to them, from this file; the other options go before it")
      ->excludes(module)
      ->excludes(machine)
      ->excludes(motor);
  command->add_option("--record", options->bench.record, "write down signals: a file that ends in .vcd or .csv");
  command->add_option("--signals", options->bench.signals, "names of them, with commas: position,stage")
      ->delimiter(',');
  command->add_option("--record-every", options->bench.record_every,
                      "how often signals are looked at that are not in the trace; default: 1ms");
  command->add_flag("--no-start", options->no_start, "do not start the program");
  command->add_flag("-q,--quiet", options->quiet, "no live line");
  command->callback([&context, options] { context.finish(run_sim(context, *options)); });
}

}  // namespace opentmcl::app
