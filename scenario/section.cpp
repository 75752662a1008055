#include "scenario/section.hpp"

#include <utility>

namespace opentmcl::scenario {
namespace {

constexpr std::size_t bench_section_count = 5;

/// Those of the bench first.
constexpr SectionName section_names[] = {
    {machine_section, "What the motor turns; a kind alone stands for it with its usual dimensions.", false},
    {encoder_section, "The encoder on its shaft.", false},
    {motor_section,
     "The motor: one of those that the twin knows by name, or such a one with other data; a name alone stands for it.",
     false},
    {load_section, "What acts on its shaft in the beginning: the quantities load.torque, load.pull and so on.", false},
    {initial_section, "Quantities as they are before the module gets its supply.", false},
    {record_section, "What is written down.", false},
    {event_section, "Something that happens at a time or under a condition.", true},
    {expect_section, "Something that must be so; what is not makes the run fail.", true},
};

constexpr std::string_view module_names[] = {tmcm1110.argument, pd1161.argument};

constexpr Key<Scenario> root[] = {
    {"module",
     ValueType::choice,
     "The module; pd1161 if it is not given.",
     [](Scenario& scenario, Value&& value) { scenario.module = value.text == tmcm1110.argument ? &tmcm1110 : &pd1161; },
     {},
     0,
     0,
     module_names},
    {"description", ValueType::text, "What this scenario shows.",
     [](Scenario& scenario, Value&& value) { scenario.description = std::move(value.text); }},
    {program_key, ValueType::text, "A TMCL program to load and start; a path from this file's folder.",
     [](Scenario& scenario, Value&& value) { scenario.program = std::move(value.text); }},
    {.name = "duration",
     .type = ValueType::time,
     .description = "The run is over after this much simulated time.",
     .store = [](Scenario& scenario, Value&& value) { scenario.duration = value.time; },
     .lowest = 1,
     .required = true},
};

constexpr Key<Recording> record[] = {
    {.name = "file",
     .type = ValueType::text,
     .description = "Where to: a path, from where the program is started, that ends in .vcd or .csv.",
     .store = [](Recording& recording, Value&& value) { recording.file = std::move(value.text); },
     .required = true},
    {.name = "signals",
     .type = ValueType::names,
     .description = "Names of what is recorded (docs/signals.md).",
     .store = [](Recording& recording, Value&& value) { recording.signals = std::move(value.texts); },
     .required = true},
    {.name = "every",
     .type = ValueType::time,
     .description = "Quantities that are not in the trace are looked at this often; 1 ms if not given.",
     .store = [](Recording& recording, Value&& value) { recording.every = value.time; },
     .lowest = 1},
    {"exact", ValueType::truth,
     "Whether what is in the trace is recorded at its tick (that is so if not given) or also looked at every so often.",
     [](Recording& recording, Value&& value) { recording.exact = value.truth; }},
    {"when", ValueType::condition, "Recording starts when this holds, and not at the begin.",
     [](Recording& recording, Value&& value) { recording.when = std::move(value.condition); }},
    {"before", ValueType::time, "What was this long before `when` held is recorded too.",
     [](Recording& recording, Value&& value) { recording.before = value.time; }},
};

constexpr Key<Event> event[] = {
    {"at", ValueType::time, "When it happens.", [](Event& target, Value&& value) { target.at = value.time; }},
    {"every", ValueType::time, "With `at`: again and again after this much time.",
     [](Event& target, Value&& value) { target.every = value.time; }},
    {"when", ValueType::condition, "What must hold for it to happen.",
     [](Event& target, Value&& value) { target.when = std::move(value.condition); }},
    {"for", ValueType::time, "With `when`: it must hold for this long.",
     [](Event& target, Value&& value) { target.held_for = value.time; }},
    {"repeat", ValueType::truth, "With `when`: again whenever it has become true anew.",
     [](Event& target, Value&& value) { target.repeat = value.truth; }},
    {"set", ValueType::assignments, "Quantities that change at once.",
     [](Event& target, Value&& value) { target.set = std::move(value.assignments); }},
    {"pulse", ValueType::assignments, "Quantities that change for the time `lasting` and then go back.",
     [](Event& target, Value&& value) { target.pulse = std::move(value.assignments); }},
    {"lasting", ValueType::time, "How long a pulse is.",
     [](Event& target, Value&& value) { target.lasting = value.time; }},
    {"ramp", ValueType::assignments, "Quantities that change evenly in the time `over`.",
     [](Event& target, Value&& value) { target.ramp = std::move(value.assignments); }},
    {"over", ValueType::time, "How long a ramp takes.", [](Event& target, Value&& value) { target.over = value.time; }},
    {"send", ValueType::commands, "TMCL commands to the module; one that it refuses makes the run fail.",
     [](Event& target, Value&& value) { target.send = std::move(value.commands); }},
    {"power_cycle", ValueType::truth, "Takes the supply away and gives it back.",
     [](Event& target, Value&& value) { target.power_cycle = value.truth; }},
    {"note", ValueType::text, "Text for whoever watches.",
     [](Event& target, Value&& value) { target.note = std::move(value.text); }},
    {"end", ValueType::truth, "Ends the run.", [](Event& target, Value&& value) { target.end = value.truth; }},
};

constexpr Key<Expectation> expect[] = {
    {"at", ValueType::time, "When it must be so.", [](Expectation& target, Value&& value) { target.at = value.time; }},
    {"by", ValueType::time, "It must have been so once until then.",
     [](Expectation& target, Value&& value) { target.by = value.time; }},
    {"that", ValueType::condition, "What must hold.",
     [](Expectation& target, Value&& value) { target.that = std::move(value.condition); }},
    {"answer_to", ValueType::command,
     "With `at`: a TMCL command, such as GAP 207, 0, whose answer must have the value `is`.",
     [](Expectation& target, Value&& value) { target.answer_to = std::move(value.commands.front()); }},
    {"is",
     ValueType::whole,
     "The value of that answer; 0 if not given.",
     [](Expectation& target, Value&& value) { target.is = static_cast<std::int32_t>(value.number); },
     {},
     -2147483648.0,
     2147483647.0},
};

}  // namespace

std::span<const SectionName> sections() {
  return section_names;
}

std::span<const SectionName> bench_sections() {
  return sections().first(bench_section_count);
}

std::span<const Key<Scenario>> root_keys() {
  return root;
}

std::vector<std::string_view> motor_names() {
  std::vector<std::string_view> names;
  for (const twin::MotorData& motor : twin::motors()) names.push_back(motor.name);
  names.push_back(ideal_motor);
  return names;
}

std::span<const Key<Recording>> record_keys() {
  return record;
}

std::span<const Key<Event>> event_keys() {
  return event;
}

std::span<const Key<Expectation>> expect_keys() {
  return expect;
}

}  // namespace opentmcl::scenario
