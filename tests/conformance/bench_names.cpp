#include "tests/conformance/bench_names.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

#include "firmware/hal/pins.hpp"
#include "twin/chip/tmc262_choices.hpp"

namespace opentmcl::conformance {

namespace {

using twin::World;

template <class Pin>
void set_pin(World& world, Pin pin, std::int64_t level) {
  const std::uint32_t bit = 1U << static_cast<unsigned>(pin);
  world.set_inputs(level != 0 ? world.inputs() | bit : world.inputs() & ~bit);
}

template <class Pin>
std::int64_t output(const World& world, Pin pin) {
  return world.outputs() >> static_cast<unsigned>(pin) & 1U;
}

/// What is measured of the load comes to `value` with the threshold (SGT) that is set now.
void set_stall_guard_value(World& world, std::int32_t value) {
  const std::int32_t threshold = tmc262::StallGuardAndCurrent::Threshold::in(world.tmc262().stall_guard_and_current());
  world.set_load_measurement(value - twin::tmc262_choices::stall_guard_threshold_weight * threshold);
}

/// "input 3" → 3 for the prefix "input "; -1 when `name` is something else.
int number_behind(std::string_view name, std::string_view prefix) {
  const bool fits = name.size() == prefix.size() + 1 && name.substr(0, prefix.size()) == prefix && name.back() >= '0' &&
                    name.back() <= '7';
  return fits ? name.back() - '0' : -1;
}

struct Control {
  std::string_view name;
  void (*set)(World& world, std::int64_t value);
};

constexpr Control controls[] = {
    {"left switch", [](World& world, std::int64_t value) { world.set_left_switch(value != 0); }},
    {"right switch", [](World& world, std::int64_t value) { world.set_right_switch(value != 0); }},
    {"home switch", [](World& world, std::int64_t value) { world.set_home_switch(value != 0); }},
    {"enable", [](World& world, std::int64_t value) { set_pin(world, hal::InputPin::step_dir_enable, value); }},
    {"analog 0", [](World& world, std::int64_t value) { world.set_analog_input(0, static_cast<std::int32_t>(value)); }},
    {"load", [](World& world, std::int64_t value) { set_stall_guard_value(world, static_cast<std::int32_t>(value)); }},
    {"step input",
     [](World& world, std::int64_t value) {
       for (std::int64_t i = 0; i < (value < 0 ? -value : value); ++i) world.pulse_step_input(value < 0);
     }},
    {"supply", [](World& world, std::int64_t value) { world.set_supply_voltage(static_cast<std::int32_t>(value)); }},
    {"temperature", [](World& world, std::int64_t value) { world.set_temperature(static_cast<std::int32_t>(value)); }},
};

struct Probe {
  std::string_view name;
  std::int64_t (*value)(const World& world);
};

template <class FieldOf>
std::int64_t driver_control(const World& world) {
  return FieldOf::in(world.tmc262().driver_control());
}
template <class FieldOf>
std::int64_t chopper(const World& world) {
  return FieldOf::in(world.tmc262().chopper_configuration());
}
template <class FieldOf>
std::int64_t cool_step(const World& world) {
  return FieldOf::in(world.tmc262().cool_step_control());
}
template <class FieldOf>
std::int64_t stall_guard(const World& world) {
  return FieldOf::in(world.tmc262().stall_guard_and_current());
}
template <class FieldOf>
std::int64_t driver(const World& world) {
  return FieldOf::in(world.tmc262().driver_configuration());
}

constexpr Probe probes[] = {
    {"pull-ups", [](const World& world) { return output(world, hal::OutputPin::pull_ups); }},
    {"rotor", [](const World& world) { return world.rotor_angle(); }},
    {"current", [](const World& world) -> std::int64_t { return world.tmc262().current_scale(); }},
    {"bridges", [](const World& world) -> std::int64_t { return world.tmc262().bridges_on() ? 1 : 0; }},
    {"INTPOL", driver_control<tmc262::DriverControl::Interpolation>},
    {"DEDGE", driver_control<tmc262::DriverControl::StepOnBothEdges>},
    {"MRES", driver_control<tmc262::DriverControl::Resolution>},
    {"TBL", chopper<tmc262::ChopperConfiguration::BlankTime>},
    {"CHM", chopper<tmc262::ChopperConfiguration::ConstantOffTime>},
    {"RNDTF", chopper<tmc262::ChopperConfiguration::RandomOffTime>},
    {"HDEC", chopper<tmc262::ChopperConfiguration::HysteresisDecrement>},
    {"HDEC1", chopper<tmc262::ChopperConfiguration::FastDecayByTimerOnly>},
    {"HDEC0", chopper<tmc262::ChopperConfiguration::FastDecayTimeTopBit>},
    {"HEND", chopper<tmc262::ChopperConfiguration::HysteresisEnd>},
    {"HSTRT", chopper<tmc262::ChopperConfiguration::HysteresisStart>},
    {"TOFF", chopper<tmc262::ChopperConfiguration::OffTime>},
    {"SEIMIN", cool_step<tmc262::CoolStepControl::MinimumCurrent>},
    {"SEDN", cool_step<tmc262::CoolStepControl::CurrentDownStep>},
    {"SEMAX", cool_step<tmc262::CoolStepControl::HysteresisWidth>},
    {"SEUP", cool_step<tmc262::CoolStepControl::CurrentUpStep>},
    {"SEMIN", cool_step<tmc262::CoolStepControl::HysteresisStart>},
    {"SFILT", stall_guard<tmc262::StallGuardAndCurrent::Filter>},
    {"SGT", stall_guard<tmc262::StallGuardAndCurrent::Threshold>},
    {"CS", stall_guard<tmc262::StallGuardAndCurrent::CurrentScale>},
    {"SLPH", driver<tmc262::DriverConfiguration::SlopeHigh>},
    {"SLPL", driver<tmc262::DriverConfiguration::SlopeLow>},
    {"DISS2G", driver<tmc262::DriverConfiguration::DisableShortProtection>},
    {"TS2G", driver<tmc262::DriverConfiguration::ShortDetectionTime>},
    {"VSENSE", driver<tmc262::DriverConfiguration::LowSenseVoltage>},
};

template <class Entry, std::size_t count>
const Entry& find(const Entry (&table)[count], std::string_view name) {
  const Entry* const entry =
      std::find_if(std::begin(table), std::end(table), [name](const Entry& row) { return row.name == name; });
  if (entry == std::end(table)) throw std::runtime_error("nothing at the bench is called \"" + std::string(name) + '"');
  return *entry;
}

}  // namespace

void set_world(World& world, std::string_view name, std::int64_t value) {
  if (const int input = number_behind(name, "input "); input >= 0) {
    set_pin(world, static_cast<unsigned>(hal::InputPin::in0) + static_cast<unsigned>(input), value);
    return;
  }
  find(controls, name).set(world, value);
}

std::int64_t look_at(const World& world, std::string_view name) {
  if (const int number = number_behind(name, "output "); number >= 0) {
    return output(world, static_cast<unsigned>(hal::OutputPin::out0) + static_cast<unsigned>(number));
  }
  return find(probes, name).value(world);
}

}  // namespace opentmcl::conformance
