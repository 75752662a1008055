#include "scenario/section.hpp"

#include <cmath>
#include <utility>

namespace opentmcl::scenario {
namespace {

constexpr double micrometres_in_a_millimetre = 1000;

constexpr SectionName section_names[] = {
    {machine_section, "What the motor turns.", false},
    {initial_section, "Quantities as they are before the module gets its supply.", false},
    {record_section, "What is written down.", false},
    {event_section, "Something that happens at a time or under a condition.", true},
    {expect_section, "Something that must be so; what is not makes the run fail.", true},
};

constexpr std::string_view module_names[] = {tmcm1110.argument, pd1161.argument};
constexpr std::string_view machine_kinds[] = {"stage", "free"};
constexpr std::string_view contact_kinds[] = {"normally closed", "normally open"};

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
    {"program", ValueType::text, "A TMCL program to load and start; a path from this file's folder.",
     [](Scenario& scenario, Value&& value) { scenario.program = std::move(value.text); }},
    {.name = "duration",
     .type = ValueType::time,
     .description = "The run is over after this much simulated time.",
     .store = [](Scenario& scenario, Value&& value) { scenario.duration = value.time; },
     .required = true},
};

/// A length of the stage that is given in mm.
template <std::int32_t twin::LinearStageDimensions::*member>
constexpr Key<MachineDescription> length(std::string_view name, double lowest, double highest,
                                         std::string_view description) {
  return {name,
          ValueType::number,
          description,
          [](MachineDescription& machine, Value&& value) {
            machine.stage.*member = static_cast<std::int32_t>(std::lround(value.number * micrometres_in_a_millimetre));
          },
          "mm",
          lowest,
          highest};
}

using Stage = twin::LinearStageDimensions;

constexpr Key<MachineDescription> machine[] = {
    {.name = "kind",
     .type = ValueType::choice,
     .description = "A linear stage with its switches, or a free shaft without end.",
     .store =
         [](MachineDescription& target, Value&& value) {
           target.kind = value.text == "free" ? MachineDescription::Kind::free : MachineDescription::Kind::stage;
         },
     .choices = machine_kinds},
    length<&Stage::pitch>("pitch", 0.1, 100, "Way of the slider in a turn of the shaft."),
    length<&Stage::travel>("travel", 1, 10'000, "From one hard end to the other."),
    length<&Stage::start>("start", -5'000, 5'000, "Where the slider stands in the beginning, from the middle."),
    {.name = "mirrored",
     .type = ValueType::truth,
     .description = "The motor sits at the other end: positive angles move the slider to the left.",
     .store = [](MachineDescription& target, Value&& value) { target.stage.mirrored = value.truth; }},
    length<&Stage::limit_switch_distance>("limit_switch_distance", 0, 5'000,
                                          "From a hard end to where the switch closest to it begins."),
    length<&Stage::limit_switch_width>("limit_switch_width", 0, 5'000, "Way on which the slider holds a limit switch."),
    length<&Stage::home_switch_center>("home_switch_center", -5'000, 5'000, "Middle of the home switch."),
    length<&Stage::home_switch_width>("home_switch_width", 0, 5'000, "Way on which the slider holds the home switch."),
    {.name = "contact",
     .type = ValueType::choice,
     .description = "Kind of the three switches.",
     .store =
         [](MachineDescription& target, Value&& value) {
           target.stage.contact =
               value.text == contact_kinds[1] ? Stage::Contact::normally_open : Stage::Contact::normally_closed;
         },
     .choices = contact_kinds},
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
    {"every", ValueType::time, "Quantities that are not in the trace are looked at this often; 1 ms if not given.",
     [](Recording& recording, Value&& value) { recording.every = value.time; }},
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
     ValueType::number,
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

std::span<const Key<Scenario>> root_keys() {
  return root;
}

std::span<const Key<MachineDescription>> machine_keys() {
  return machine;
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
