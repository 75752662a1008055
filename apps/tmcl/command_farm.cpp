// tmcl farm: many virtual modules in one process.

#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/tmcl/assembler_choice.hpp"
#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/motion_state.hpp"
#include "apps/tmcl/quantity.hpp"
#include "apps/tmcl/source_program.hpp"
#include "apps/tmcl/status_line.hpp"
#include "server/farm_file.hpp"
#include "server/farm_site.hpp"

namespace opentmcl::app {

namespace asio = boost::asio;
using client::Error;
using client::ErrorKind;
using client::Result;
using server::FarmSite;

namespace {

struct FarmOptions {
  std::string file;
  AssemblerChoice assembler;
  std::string speed = "1";
  std::string duration;
  bool check = false;
  bool quiet = false;
};

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

Result<server::FarmDescription> read_description(const std::string& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  server::FarmFile file = server::read_farm(*text, path);
  for (const std::string& problem : file.problems) fmt::print(stderr, "{}\n", problem);
  if (file.problems.empty()) return std::move(file.description);
  return Error{ErrorKind::bad_file, fmt::format("{} has {}", path, counted(file.problems.size(), "error")), {}};
}

/// The programs of a farm, each file assembled once for each kind of module.
class Programs {
 public:
  Result<void> assemble_all(const server::FarmDescription& farm, const AssemblerChoice& choice) {
    for (const server::FarmModule& module : farm.modules) {
      if (module.program.empty()) continue;
      const auto [place, is_new] = programs_.try_emplace({module.program, module.kind->id});
      if (!is_new) continue;
      const Result<lang::AssemblyResult> assembled =
          assemble_file(module.program, assembler_options(choice, *module.kind));
      if (!assembled) return assembled.error();
      place->second = assembled->program->commands;
    }
    return {};
  }
  const std::vector<Command>& operator()(const server::FarmModule& module) const {
    return programs_.at({module.program, module.kind->id});
  }

 private:
  std::map<std::pair<std::string, ModuleId>, std::vector<Command>> programs_;
};

/// Each module needs some files of the operating system, which allows few at first.
void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  // Without them the farm says which module got none.
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

void introduce_as_json(const std::vector<FarmSite::Place>& places) {
  nlohmann::ordered_json modules = nlohmann::ordered_json::array();
  nlohmann::ordered_json buses = nlohmann::ordered_json::array();
  for (const FarmSite::Place& place : places) {
    nlohmann::ordered_json entry{{"name", *place.name},
                                 {"kind", place.kind},
                                 {"link", place.doors->link()},
                                 {"tcp", place.doors->tcp_url()},
                                 {"slcan_link", place.doors->slcan_link()},
                                 {"can_udp", place.doors->can_url()}};
    if (place.is_bus) {
      buses.push_back(std::move(entry));
      continue;
    }
    entry["bus"] = place.bus != nullptr ? *place.bus : std::string();
    if (place.bus != nullptr) entry["address"] = place.address;
    modules.push_back(std::move(entry));
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"modules", std::move(modules)}, {"buses", std::move(buses)}}.dump());
}

std::string doors_of(const FarmSite::Place& place) {
  std::string text = place.bus != nullptr ? fmt::format("address {} on {}", place.address, *place.bus) : std::string();
  const auto add = [&text](const std::string& door, const char* remark) {
    if (!door.empty()) text += fmt::format("{}{}{}", text.empty() ? "" : "  ", door, remark);
  };
  add(place.doors->link(), "");
  add(place.doors->tcp_url(), "");
  add(place.doors->slcan_link(), " (SLCAN)");
  add(place.doors->can_url(), " (CAN)");
  return text;
}

void introduce_as_text(const std::vector<FarmSite::Place>& places) {
  std::size_t widest = 0;
  for (const FarmSite::Place& place : places) widest = std::max(widest, place.name->size());
  for (const FarmSite::Place& place : places) {
    fmt::print("{:<{}}  {:<9}  {}\n", *place.name, widest, place.kind, doors_of(place));
  }
  fmt::print("Ctrl-C ends it.\n");
}

void introduce(const Context& context, const std::vector<FarmSite::Place>& places) {
  if (context.json) {
    introduce_as_json(places);
  } else {
    introduce_as_text(places);
  }
  std::fflush(stdout);
}

/// Shows once a second what the farm does.
class FarmDisplay {
 public:
  FarmDisplay(asio::io_context& events, FarmSite& site) : timer_(events), site_(site) { refresh(); }

 private:
  static constexpr std::chrono::seconds period{1};

  void refresh() {
    std::size_t moving = 0;
    std::size_t running = 0;
    for (std::size_t i = 0; i < site_.module_count(); ++i) {
      const MotionState state = motion_state_of(site_.module(i));
      if (state.velocity != 0) ++moving;
      if (state.program == client::ProgramStatus::State::running) ++running;
    }
    const std::uint64_t served = site_.farm().served_turns();
    status_.show(fmt::format("{}: {} moving, {} with a running program; {} requests/s",
                             counted(site_.module_count(), "module"), moving, running, served - shown_served_));
    shown_served_ = served;
    timer_.expires_after(period);
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) refresh();
    });
  }

  asio::steady_timer timer_;
  FarmSite& site_;
  StatusLine status_;
  std::uint64_t shown_served_ = 0;
};

Result<void> run_farm(const Context& context, const FarmOptions& options) {
  const Result<double> speed = parse_speed(options.speed);
  if (!speed) return speed.error();
  server::Farm::Options pace{*speed, std::nullopt};
  if (!options.duration.empty()) {
    const Result<Microseconds> duration = parse_duration(options.duration);
    if (!duration) return duration.error();
    pace.duration = *duration;
  }
  Result<server::FarmDescription> description = read_description(options.file);
  if (!description) return description.error();
  Programs programs;
  if (Result<void> assembled = programs.assemble_all(*description, options.assembler); !assembled) return assembled;
  if (options.check) return {};

  allow_many_files();
  // This thread is the only one: nothing needs a lock.
  asio::io_context events(BOOST_ASIO_CONCURRENCY_HINT_UNSAFE);
  Result<std::unique_ptr<FarmSite>> built = FarmSite::build(events, std::move(*description), std::cref(programs), pace);
  if (!built) return built.error();
  FarmSite& site = **built;
  asio::signal_set signals(events, SIGINT, SIGTERM, SIGHUP);
  signals.async_wait([&site](const boost::system::error_code& error, int) {
    if (!error) site.farm().stop();
  });
  introduce(context, site.places());
  std::optional<FarmDisplay> display;
  if (!options.quiet) display.emplace(events, site);
  site.farm().run();
  return site.finish();
}

}  // namespace

void add_farm(CLI::App& app, Context& context) {
  auto options = std::make_shared<FarmOptions>();
  CLI::App* command =
      app.add_subcommand("farm", "many virtual modules at once, as a file describes them")->fallthrough();
  command->footer("Examples:\n  tmcl farm examples/farm/farm.toml\n  tmcl --json farm --quiet --duration 10s my.toml");
  command->add_option("FILE", options->file, "the farm in TOML (docs/farm.md)")->required();
  command->add_option("--speed", options->speed, "times real time, or max")->capture_default_str();
  command->add_option("--duration", options->duration, "end after this much of the modules' time: 5s, 500ms, 2min");
  add_assembler_options(*command, options->assembler);
  command->add_flag("--check", options->check, "only say what is wrong with the file and its programs");
  command->add_flag("-q,--quiet", options->quiet, "no live line");
  command->callback([&context, options] { context.finish(run_farm(context, *options)); });
}

}  // namespace opentmcl::app
