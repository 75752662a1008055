#include "server/control_methods.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <vector>

#include "scenario/condition.hpp"
#include "server/control.hpp"

namespace opentmcl::server {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using twin::Quantity;
using Type = ControlParameter::Type;

constexpr std::chrono::milliseconds usual_limit{10'000};
constexpr std::chrono::milliseconds longest_limit{600'000};
constexpr Microseconds usual_interval = 10'000;
constexpr Microseconds longest_look = 1'000'000'000'000;

RpcError wrong(const std::string& what) {
  return {RpcError::invalid_params, what};
}

RpcError error_of(const client::Error& error) {
  switch (error.kind) {
    case client::ErrorKind::usage:
      return {RpcError::invalid_params, error.message};
    case client::ErrorKind::bad_file:
      return {RpcError::bad_file, error.message};
    case client::ErrorKind::input_output:
      return {RpcError::input_output, error.message};
    default:
      return {RpcError::internal_error, error.message};
  }
}

const char* name_of(Quantity::Kind kind) {
  switch (kind) {
    case Quantity::Kind::truth:
      return "truth";
    case Quantity::Kind::whole:
      return "whole";
    case Quantity::Kind::real:
      return "real";
  }
  return "";
}

// ---- Looking

ordered_json description_of(const Quantity& quantity, const twin::World& world) {
  const bool is_writable = quantity.can_be_written() && !(quantity.set_by_motor && world.motor());
  ordered_json description{{"name", quantity.name},
                           {"unit", quantity.unit},
                           {"kind", name_of(quantity.kind)},
                           {"description", quantity.description},
                           {"writable", is_writable}};
  if (is_writable) {
    description["lowest"] = quantity.lowest;
    description["highest"] = quantity.highest;
  }
  return description;
}

ordered_json description_of(const ControlMethod& method) {
  ordered_json parameters = ordered_json::array();
  for (const ControlParameter& parameter : method.used_parameters()) {
    parameters.push_back({{"name", parameter.name},
                          {"type", name_of(parameter.type)},
                          {"required", parameter.is_required},
                          {"description", parameter.description}});
  }
  return {{"name", method.name},
          {"description", method.description},
          {"parameters", std::move(parameters)},
          {"result", method.result}};
}

void describe(ControlCall& call) {
  Control& control = call.control;
  const ModuleDescription& module = *control.session().setup().module;
  ordered_json quantities = ordered_json::array();
  for (const Quantity& quantity : twin::quantities()) {
    if (quantity.exists_in(control.world())) quantities.push_back(description_of(quantity, control.world()));
  }
  ordered_json methods = ordered_json::array();
  for (const ControlMethod& method : control_methods()) methods.push_back(description_of(method));
  const scenario::Scenario& scenario = control.session().scenario();
  call.answer(control.with_time({{"module", module.argument},
                                 {"machine", scenario::name_of(scenario.machine)},
                                 {"motor", scenario::name_of(scenario.motor)},
                                 {"scenario", control.session().setup().scenario_name},
                                 {"quantities", std::move(quantities)},
                                 {"methods", std::move(methods)}}));
}

/// The quantities that "names" means; those that do not exist are an error.
std::optional<RpcError> find_named(ControlCall& call, std::vector<const Quantity*>& found) {
  const twin::World& world = call.control.world();
  const auto names = call.parameters.find("names");
  if (names == call.parameters.end()) {
    for (const Quantity& quantity : twin::quantities()) {
      if (quantity.exists_in(world)) found.push_back(&quantity);
    }
    return std::nullopt;
  }
  for (const json& name : names->is_array() ? *names : json::array({*names})) {
    const auto text = name.get<std::string>();
    const Quantity* quantity = twin::find_quantity(text);
    if (quantity == nullptr) return wrong(scenario::no_such_quantity(text));
    if (!quantity->exists_in(world)) return wrong(text + " does not exist on this machine");
    found.push_back(quantity);
  }
  return std::nullopt;
}

ordered_json values_of(const std::vector<const Quantity*>& quantities, const twin::World& world) {
  ordered_json values = ordered_json::object();
  for (const Quantity* quantity : quantities) values[std::string(quantity->name)] = value_of(*quantity, world);
  return values;
}

void get(ControlCall& call) {
  std::vector<const Quantity*> quantities;
  if (const auto error = find_named(call, quantities)) return call.answer(*error);
  call.control.catch_up();
  call.answer(call.control.with_time({{"values", values_of(quantities, call.control.world())}}));
}

void time(ControlCall& call) {
  Control& control = call.control;
  control.catch_up();
  const LiveSimulation& simulation = control.simulation();
  ordered_json speed = simulation.speed();
  if (simulation.speed() == Pace::maximum) speed = "max";
  call.answer(control.with_time({{"paused", simulation.is_paused()},
                                 {"speed", std::move(speed)},
                                 {"turns", control.session().module().turns()}}));
}

void subscribe(ControlCall& call) {
  if (call.control.subscriptions_of(call.client) >= Control::most_subscriptions) {
    return call.answer(wrong("a client has 100 subscriptions at most"));
  }
  std::vector<const Quantity*> quantities;
  if (const auto error = find_named(call, quantities)) return call.answer(*error);
  const Microseconds every = call.parameters.value("every", usual_interval);
  if (every == 0) return call.answer(wrong("every is at least 1 us"));
  call.control.catch_up();
  const std::uint64_t number = call.control.subscribe(call.client, quantities, every);
  call.answer(
      call.control.with_time({{"subscription", number}, {"values", values_of(quantities, call.control.world())}}));
}

void unsubscribe(ControlCall& call) {
  const auto number = call.parameters.at("subscription").get<std::uint64_t>();
  if (!call.control.unsubscribe(call.client, number)) {
    return call.answer(wrong("this client has no subscription " + std::to_string(number)));
  }
  call.answer(call.control.with_time(ordered_json::object()));
}

// ---- Changing

std::optional<RpcError> read_values(ControlCall& call, std::vector<QuantitiesSet::Value>& values) {
  for (const auto& [name, given] : call.parameters.at("values").items()) {
    const Quantity* quantity = twin::find_quantity(name);
    if (quantity == nullptr) return wrong(scenario::no_such_quantity(name));
    const double value = given.is_boolean() ? (given.get<bool>() ? 1 : 0) : given.get<double>();
    if (const auto refusal = twin::refusal(*quantity, call.control.world(), value)) return wrong(name + " " + *refusal);
    values.push_back({name, value});
  }
  if (values.empty()) return wrong("values has nothing to set");
  return std::nullopt;
}

void set(ControlCall& call) {
  std::vector<QuantitiesSet::Value> values;
  if (const auto error = read_values(call, values)) return call.answer(*error);
  call.control.catch_up();
  call.control.session().set(values);
  call.answer(call.control.with_time(ordered_json::object()));
}

void power_cycle(ControlCall& call) {
  call.control.catch_up();
  call.control.session().power_cycle();
  call.answer(call.control.with_time(ordered_json::object()));
}

// ---- Time

void pause(ControlCall& call) {
  call.control.catch_up();
  call.control.simulation().pause();
  call.answer(call.control.with_time(ordered_json::object()));
}

void resume(ControlCall& call) {
  call.control.simulation().resume();
  call.answer(call.control.with_time(ordered_json::object()));
}

void set_speed(ControlCall& call) {
  const json& speed = call.parameters.at("speed");
  call.control.catch_up();
  call.control.simulation().set_speed(speed.is_string() ? Pace::maximum : speed.get<double>());
  call.answer(call.control.with_time(ordered_json::object()));
}

/// How long the client wants to wait, on the wall clock.
std::optional<RpcError> read_limit(const ControlCall& call, std::chrono::milliseconds& limit) {
  const auto given = call.parameters.value("limit", std::uint64_t(usual_limit.count()));
  if (given > std::uint64_t(longest_limit.count())) return wrong("limit is at most 600000 ms");
  limit = std::chrono::milliseconds(given);
  return std::nullopt;
}

void step(ControlCall& call) {
  std::chrono::milliseconds limit{};
  if (const auto error = read_limit(call, limit)) return call.answer(*error);
  const auto by = call.parameters.find("by");
  const auto turns = call.parameters.find("turns");
  if ((by == call.parameters.end()) == (turns == call.parameters.end())) {
    return call.answer(wrong("either by or turns says how far"));
  }
  if (!call.control.simulation().is_paused()) call.control.catch_up();
  const VirtualModule& module = call.control.session().module();
  LiveSimulation::Goal goal;
  if (by != call.parameters.end()) {
    goal.time = module.now() + std::min(by->get<Microseconds>(), never - 1 - module.now());
  } else {
    goal.turns = module.turns() + std::min(turns->get<std::uint64_t>(), std::uint64_t{1} << 62);
  }
  call.control.run_to(goal, limit, call.answer);
}

void advance(ControlCall& call) {
  std::chrono::milliseconds limit{};
  if (const auto error = read_limit(call, limit)) return call.answer(*error);
  const auto to = call.parameters.at("to").get<Microseconds>();
  if (!call.control.simulation().is_paused()) call.control.catch_up();
  const Microseconds now = call.control.session().module().now();
  if (to < now) return call.answer(wrong("to is in the past: it is " + std::to_string(now) + " us"));
  call.control.run_to({.time = std::min(to, never - 1)}, limit, call.answer);
}

// ---- The session

void start_recording(ControlCall& call) {
  scenario::Recording recording;
  recording.file = call.parameters.at("path").get<std::string>();
  recording.every = call.parameters.value("every", recording.every);
  if (recording.every == 0 || recording.every > longest_look) {
    return call.answer(wrong("every is 1 us to 1000000000000 us"));
  }
  if (const auto names = call.parameters.find("signals"); names != call.parameters.end()) {
    for (const json& name : names->is_array() ? *names : json::array({*names})) recording.signals.push_back(name);
  }
  call.control.catch_up();
  const client::Result<std::uint64_t> number = call.control.session().start_recording(std::move(recording));
  if (!number) return call.answer(error_of(number.error()));
  call.answer(call.control.with_time({{"recording", *number}}));
}

void stop_recording(ControlCall& call) {
  call.control.catch_up();
  const auto number = call.parameters.at("recording").get<std::uint64_t>();
  const client::Result<std::string> path = call.control.session().stop_recording(number);
  if (!path) return call.answer(error_of(path.error()));
  call.answer(call.control.with_time({{"path", *path}}));
}

void save(ControlCall& call) {
  call.control.catch_up();
  const auto path = call.parameters.at("path").get<std::string>();
  if (const auto saved = call.control.session().save(path); !saved) return call.answer(error_of(saved.error()));
  call.answer(call.control.with_time({{"path", path}}));
}

void load(ControlCall& call) {
  const auto path = call.parameters.at("path").get<std::string>();
  if (const auto loaded = call.control.load(path); !loaded) return call.answer(error_of(loaded.error()));
  call.answer(call.control.with_time({{"path", path}}));
}

void quit(ControlCall& call) {
  call.control.simulation().stop();
  call.answer(call.control.with_time(ordered_json::object()));
}

// ---- The table

constexpr ControlParameter limit_parameter = {"limit", Type::count, false,
                                              "how long this may take on the wall clock, in ms; 10000, at most 600000"};

constexpr ControlMethod methods[] = {
    {"describe",
     "Everything there is: quantities with their units and ranges, and methods.",
     {},
     "module, machine, motor, scenario: the name of its file, quantities, methods",
     describe},
    {"get",
     "Looks at quantities.",
     {{"names", Type::names, false, "which; all of them without"}},
     "values: by name",
     get},
    {"set",
     "Changes quantities, all at once: a supply, a switch, a wire. If one of them cannot be changed, none is.",
     {{"values", Type::values, true, "new values by name, in their units"}},
     "",
     set},
    {"power_cycle", "Takes the module's supply away and gives it back.", {}, "", power_cycle},
    {"time", "The state of time.", {}, "paused, speed, turns: those the firmware has taken", time},
    {"pause", "Time stands still. Hosts wait for their answers until it goes on.", {}, "", pause},
    {"resume", "Time goes on, at its speed.", {}, "", resume},
    {"set_speed", "How fast time goes.", {{"speed", Type::speed, true, "times real time, or \"max\""}}, "", set_speed},
    {"step",
     "Lets some time pass, as fast as possible, and pauses then.",
     {{"by", Type::count, false, "how long, in us"},
      {"turns", Type::count, false, "or: how many turns of the firmware's main loop"},
      limit_parameter},
     "reached: false if the firmware had no more turns to take; turns: those it took",
     step},
    {"advance",
     "Lets time pass until a certain time, as fast as possible, and pauses then.",
     {{"to", Type::count, true, "when, in us since the module was switched on"}, limit_parameter},
     "reached, turns: as of step",
     advance},
    {"subscribe",
     "Tells of changes from now on: a notification `changed` with time, subscription and the values that are others "
     "than before.",
     {{"names", Type::names, false, "of which quantities; all of them without"},
      {"every", Type::count, false, "looks at multiples of this, in us of simulated time; 10000"}},
     "subscription: its number; values: all of them, now",
     subscribe},
    {"unsubscribe", "No more of that.", {{"subscription", Type::count, true, "its number"}}, "", unsubscribe},
    {"start_recording",
     "Writes down how signals change, from now on, to a file whose name ends in .vcd or .csv and which is replaced.",
     {{"path", Type::text, true, "of the file"},
      {"signals", Type::names, false, "which, as in docs/signals.md; some usual ones without"},
      {"every", Type::count, false, "looks at those that are not in the trace this often, in us; 1000"}},
     "recording: its number",
     start_recording},
    {"stop_recording",
     "Ends a recording, also one of another client. The end of the simulation does so too.",
     {{"recording", Type::count, true, "its number"}},
     "path",
     stop_recording},
    {"save",
     "Writes a snapshot of the whole state to a file.",
     {{"path", Type::text, true, "of the file, which is replaced"}},
     "path",
     save},
    {"load",
     "Goes to the state of a snapshot, from which everything goes on as it did then. Hosts stay connected.",
     {{"path", Type::text, true, "of the file"}},
     "path",
     load},
    {"quit", "Ends the simulation.", {}, "", quit},
};

}  // namespace

std::span<const ControlParameter> ControlMethod::used_parameters() const {
  std::size_t count = 0;
  while (count < most_parameters && parameters[count].name != nullptr) ++count;
  return {parameters, count};
}

std::span<const ControlMethod> control_methods() {
  return methods;
}

const ControlMethod* find_control_method(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(methods), std::end(methods), [&](const ControlMethod& row) { return name == row.name; });
  return found == std::end(methods) ? nullptr : found;
}

}  // namespace opentmcl::server
