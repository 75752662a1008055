// tmcl sim ctl: the bench around a virtual module that runs, from the shell.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/interruption.hpp"
#include "apps/tmcl/quantity.hpp"
#include "server/control_caller.hpp"
#include "server/control_server.hpp"
#include "server/pty_link.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using nlohmann::ordered_json;
using server::ControlCaller;

namespace {

struct CtlOptions {
  std::string control;
  std::vector<std::string> names;
  std::vector<std::string> assignments;
  std::string span;
  std::uint64_t turns = 0;
  std::string within = "10s";
  std::string speed;
  std::string path;
  std::string every;
  std::vector<std::string> signals;
  std::uint64_t count = 0;
  std::uint64_t recording = 0;
  std::string method;
  std::string parameters = "{}";
};

/// The simulation that the user means: the one at --control, else the only one that runs at a usual place.
Result<ControlCaller> connect(const std::string& control) {
  if (!control.empty()) return ControlCaller::connect(control);
  std::optional<ControlCaller> found;
  std::string usual_places;
  for (const ModuleDescription& module : modules) {
    const std::string path = server::control_path_of(server::default_link_path(module.argument));
    usual_places += (usual_places.empty() ? "" : " or ") + path;
    Result<ControlCaller> caller = ControlCaller::connect(path);
    if (!caller) continue;
    if (found) {
      return Error{ErrorKind::usage, "several simulations are running: choose one with --control, " + usual_places, {}};
    }
    found.emplace(std::move(*caller));
  }
  if (found) return std::move(*found);
  return Error{ErrorKind::no_such_device, "no simulation is running: nobody listens at " + usual_places, {}};
}

/// A connection, and what all requests need.
class Asker {
 public:
  static Result<Asker> make(const Context& context, const CtlOptions& options) {
    const Result<Microseconds> limit = parse_duration(context.time_limit);
    if (!limit) return limit.error();
    Result<ControlCaller> caller = connect(options.control);
    if (!caller) return caller.error();
    return Asker(std::move(*caller), std::chrono::milliseconds(*limit / one_millisecond + 1));
  }

  Result<ordered_json> call(const std::string& method, const ordered_json& parameters = ordered_json::object(),
                            std::chrono::milliseconds longer = {}) {
    return caller_.call(method, parameters, limit_ + longer);
  }
  ControlCaller& caller() { return caller_; }

 private:
  Asker(ControlCaller caller, std::chrono::milliseconds limit) : caller_(std::move(caller)), limit_(limit) {}

  ControlCaller caller_;
  std::chrono::milliseconds limit_;
};

using Units = std::map<std::string, std::string>;

Result<Units> units_of(Asker& asker) {
  const Result<ordered_json> description = asker.call("describe");
  if (!description) return description.error();
  Units units;
  for (const ordered_json& quantity : description->at("quantities")) units[quantity.at("name")] = quantity.at("unit");
  return units;
}

std::string text_of(const std::string& name, const ordered_json& value, const Units& units) {
  const auto unit = units.find(name);
  const std::string number = value.is_boolean() ? (value.get<bool>() ? "1" : "0") : value.dump();
  return unit == units.end() || unit->second.empty() ? number : number + ' ' + unit->second;
}

std::string seconds(const ordered_json& result) {
  return fmt::format("{:.6f} s", static_cast<double>(result.at("time").get<std::uint64_t>()) / 1e6);
}

/// Prints a result as JSON, or only its time.
void print_time(const Context& context, const ordered_json& result) {
  fmt::print("{}\n", context.json ? result.dump() : seconds(result));
}

Result<void> ask(const Context& context, const CtlOptions& options, const std::string& method,
                 const ordered_json& parameters, std::chrono::milliseconds longer = {}) {
  Result<Asker> asker = Asker::make(context, options);
  if (!asker) return asker.error();
  const Result<ordered_json> result = asker->call(method, parameters, longer);
  if (!result) return result.error();
  print_time(context, *result);
  return {};
}

// ---- The commands

Result<void> describe(const Context& context, const CtlOptions& options) {
  Result<Asker> asker = Asker::make(context, options);
  if (!asker) return asker.error();
  const Result<ordered_json> result = asker->call("describe");
  if (!result) return result.error();
  if (context.json) {
    fmt::print("{}\n", result->dump());
    return {};
  }
  for (const ordered_json& quantity : result->at("quantities")) {
    std::string range = "read only";
    if (quantity.at("writable").get<bool>()) {
      range = fmt::format("{} to {}", quantity.at("lowest").dump(), quantity.at("highest").dump());
    }
    fmt::print("{:28} {:5} {:18} {}\n", quantity.at("name").get<std::string>(), quantity.at("unit").get<std::string>(),
               range, quantity.at("description").get<std::string>());
  }
  return {};
}

Result<void> get(const Context& context, const CtlOptions& options) {
  Result<Asker> asker = Asker::make(context, options);
  if (!asker) return asker.error();
  ordered_json parameters = ordered_json::object();
  if (!options.names.empty()) parameters["names"] = options.names;
  const Result<ordered_json> result = asker->call("get", parameters);
  if (!result) return result.error();
  if (context.json) {
    fmt::print("{}\n", result->dump());
    return {};
  }
  const Result<Units> units = units_of(*asker);
  if (!units) return units.error();
  for (const auto& [name, value] : result->at("values").items()) {
    const std::string text = text_of(name, value, *units);
    fmt::print("{}\n", options.names.size() == 1 ? text : fmt::format("{} = {}", name, text));
  }
  return {};
}

Result<ordered_json> parse_assignments(const std::vector<std::string>& assignments) {
  ordered_json values = ordered_json::object();
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    const std::string name = assignment.substr(0, equals);
    const std::string text = equals == std::string::npos ? "" : assignment.substr(equals + 1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) {
      return Error{ErrorKind::usage,
                   fmt::format("\"{}\" sets nothing: expected NAME=NUMBER, as supply_voltage=12.5", assignment),
                   {}};
    }
    values[name] = value;
  }
  return values;
}

Result<void> set(const Context& context, const CtlOptions& options) {
  const Result<ordered_json> values = parse_assignments(options.assignments);
  if (!values) return values.error();
  return ask(context, options, "set", {{"values", *values}});
}

Result<void> run_on(const Context& context, const CtlOptions& options, const std::string& method,
                    ordered_json parameters) {
  const Result<Microseconds> within = parse_duration(options.within);
  if (!within) return within.error();
  const std::chrono::milliseconds limit(*within / one_millisecond);
  parameters["limit"] = limit.count();
  return ask(context, options, method, parameters, limit);
}

Result<void> step(const Context& context, const CtlOptions& options) {
  if (options.turns > 0) return run_on(context, options, "step", {{"turns", options.turns}});
  const Result<Microseconds> by = parse_duration(options.span);
  if (!by) return by.error();
  return run_on(context, options, "step", {{"by", *by}});
}

Result<void> advance(const Context& context, const CtlOptions& options) {
  const Result<Microseconds> to = parse_duration(options.span);
  if (!to) return to.error();
  return run_on(context, options, "advance", {{"to", *to}});
}

Result<void> set_speed(const Context& context, const CtlOptions& options) {
  const Result<double> speed = parse_speed(options.speed);
  if (!speed) return speed.error();
  ordered_json parameter = *speed;
  if (*speed == server::Pace::maximum) parameter = "max";
  return ask(context, options, "set_speed", {{"speed", parameter}});
}

Result<void> ask_with_path(const Context& context, const CtlOptions& options, const std::string& method) {
  // The simulation may have been started elsewhere. To replay a long session takes a while.
  constexpr std::chrono::minutes patience{10};
  const std::string path = std::filesystem::absolute(options.path).string();
  return ask(context, options, method, {{"path", path}}, patience);
}

/// With "every" if the user says it.
Result<ordered_json> parameters_with_interval(const CtlOptions& options) {
  ordered_json parameters = ordered_json::object();
  if (options.every.empty()) return parameters;
  const Result<Microseconds> every = parse_duration(options.every);
  if (!every) return every.error();
  parameters["every"] = *every;
  return parameters;
}

Result<void> record(const Context& context, const CtlOptions& options) {
  Result<ordered_json> parameters = parameters_with_interval(options);
  if (!parameters) return parameters.error();
  // The simulation may have been started elsewhere.
  (*parameters)["path"] = std::filesystem::absolute(options.path).string();
  if (!options.signals.empty()) (*parameters)["signals"] = options.signals;
  Result<Asker> asker = Asker::make(context, options);
  if (!asker) return asker.error();
  const Result<ordered_json> result = asker->call("start_recording", *parameters);
  if (!result) return result.error();
  fmt::print("{}\n", context.json ? result->dump() : result->at("recording").dump());
  return {};
}

Result<void> stop_recording(const Context& context, const CtlOptions& options) {
  return ask(context, options, "stop_recording", {{"recording", options.recording}});
}

void print_change(const Context& context, const ordered_json& change, const Units& units) {
  if (context.json) {
    fmt::print("{}\n", change.dump());
  } else {
    for (const auto& [name, value] : change.at("values").items()) {
      fmt::print("{}  {} = {}\n", seconds(change), name, text_of(name, value, units));
    }
  }
  std::fflush(stdout);
}

Result<void> watch(const Context& context, const CtlOptions& options) {
  Result<ordered_json> parameters = parameters_with_interval(options);
  if (!parameters) return parameters.error();
  Result<Asker> asker = Asker::make(context, options);
  if (!asker) return asker.error();
  const Result<Units> units = units_of(*asker);
  if (!units) return units.error();
  if (!options.names.empty()) (*parameters)["names"] = options.names;
  const Result<ordered_json> first = asker->call("subscribe", *parameters);
  if (!first) return first.error();
  const Interruption interruption;
  print_change(context, *first, *units);
  for (std::uint64_t count = 0; options.count == 0 || count < options.count; ++count) {
    constexpr std::chrono::milliseconds look_at_interruption{100};
    Result<ordered_json> change = asker->caller().next_notification(look_at_interruption);
    while (!change && change.error().kind == ErrorKind::timeout && !interruption.requested()) {
      change = asker->caller().next_notification(look_at_interruption);
    }
    if (interruption.requested()) return {};
    if (!change) return change.error();
    print_change(context, *change, *units);
  }
  return {};
}

Result<void> call(const Context& context, const CtlOptions& options) {
  constexpr bool with_exceptions = false;
  const ordered_json parameters = ordered_json::parse(options.parameters, nullptr, with_exceptions);
  if (!parameters.is_object() && !parameters.is_array()) {
    return Error{ErrorKind::usage, "\"" + options.parameters + "\" is no JSON object or array", {}};
  }
  Result<Asker> asker = Asker::make(context, options);
  if (!asker) return asker.error();
  constexpr std::chrono::minutes longest_limit{10};
  const Result<ordered_json> result = asker->call(options.method, parameters, longest_limit);
  if (!result) return result.error();
  fmt::print("{}\n", result->dump());
  return {};
}

constexpr const char* footer = R"(Examples:
  tmcl sim ctl get supply_voltage position
  tmcl sim ctl set supply_voltage=12 left_switch.held_open=1
  tmcl sim ctl pause && tmcl sim ctl step 10ms && tmcl sim ctl get velocity
  tmcl sim ctl watch stage --every 100ms
  tmcl sim ctl record move.vcd --signals position,rotor.load_angle
  tmcl sim ctl save before.snapshot

Without --control: the only simulation that runs at a usual place. See docs/control.md.)";

}  // namespace

void add_sim_ctl(CLI::App& sim, Context& context) {
  auto options = std::make_shared<CtlOptions>();
  CLI::App* ctl = sim.add_subcommand("ctl", "look at and change the bench around a running simulation")->fallthrough();
  ctl->require_subcommand(1);
  ctl->footer(footer);
  ctl->add_option("--control", options->control, "its socket, as tmcl sim says at the start");

  using Command = std::function<Result<void>(const Context&, const CtlOptions&)>;
  const auto add = [&](const char* name, const char* description, const Command& command) {
    CLI::App* added = ctl->add_subcommand(name, description)->fallthrough();
    added->callback([&context, options, command] { context.finish(command(context, *options)); });
    return added;
  };
  const auto add_plain = [&](const char* name, const char* description, const char* method) {
    CLI::App* added = add(name, description, [method](const Context& with, const CtlOptions& given) {
      return ask(with, given, method, ordered_json::object());
    });
    if (std::string_view(name) != method) added->alias(method);
  };

  add("describe", "all quantities with their units and ranges", describe);
  add("get", "look at quantities, or at all", get)->add_option("NAME", options->names, "which");
  add("set", "change quantities, all at once", set)
      ->add_option("ASSIGNMENT", options->assignments, "NAME=VALUE, in the unit of the quantity")
      ->required();
  add_plain("power-cycle", "take the module's supply away and give it back", "power_cycle");
  add_plain("time", "the module's time", "time");
  add_plain("pause", "time stands still", "pause");
  add_plain("resume", "time goes on", "resume");
  CLI::App* stepping = add("step", "let some time pass and pause", step);
  CLI::Option* span = stepping->add_option("SPAN", options->span, "how long: 10ms");
  CLI::Option* turns = stepping->add_option("--turns", options->turns, "or: how many turns of the firmware")
                           ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 62))
                           ->excludes(span);
  stepping->add_option("--within", options->within, "give up after this long")->capture_default_str();
  stepping->parse_complete_callback([span, turns] {
    if (span->count() + turns->count() == 0) throw CLI::RequiredError("SPAN or --turns");
  });
  CLI::App* advancing = add("advance", "let time pass until then and pause", advance);
  advancing->add_option("TIME", options->span, "since the module was switched on: 2s")->required();
  advancing->add_option("--within", options->within, "give up after this long")->capture_default_str();
  add("speed", "how fast time goes", set_speed)
      ->add_option("SPEED", options->speed, "times real time, or max")
      ->required();
  CLI::App* watching = add("watch", "tell of changes until Ctrl-C", watch);
  watching->add_option("NAME", options->names, "of which quantities; without: of all");
  watching->add_option("--every", options->every, "looks at multiples of this of the module's time; default: 10ms");
  watching->add_option("--count", options->count, "end after so many changes");
  CLI::App* recording = add("record", "write down how signals change; prints the recording's number", record);
  recording->add_option("FILE", options->path, "which is replaced: its name ends in .vcd or .csv")->required();
  recording->add_option("--signals", options->signals, "names of them, with commas: position,stage")->delimiter(',');
  recording->add_option("--every", options->every,
                        "how often signals are looked at that are not in the trace; default: 1ms");
  add("stop-recording", "end a recording", stop_recording)
      ->add_option("NUMBER", options->recording, "as record has printed it")
      ->required();
  add("save", "write a snapshot of the whole state",
      [](const Context& with, const CtlOptions& given) { return ask_with_path(with, given, "save"); })
      ->add_option("FILE", options->path, "which is replaced")
      ->required();
  add("load", "go to the state of a snapshot",
      [](const Context& with, const CtlOptions& given) { return ask_with_path(with, given, "load"); })
      ->add_option("FILE", options->path, "the snapshot")
      ->required();
  add_plain("quit", "end the simulation", "quit");
  CLI::App* calling = add("call", "call a method of docs/control.md and print its result as JSON", call);
  calling->add_option("METHOD", options->method, "its name")->required();
  calling->add_option("PARAMETERS", options->parameters, "a JSON object")->capture_default_str();
}

}  // namespace opentmcl::app
