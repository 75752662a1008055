// The keys of [machine], [encoder] and [motor].
#include <cmath>

#include "scenario/section.hpp"
#include "twin/physics/shaft.hpp"

namespace opentmcl::scenario {
namespace {

using Stage = twin::LinearStageDimensions;
using Table = twin::CircularAxisDimensions;
using Shaft = twin::RotaryAxisDimensions;
using Encoder = twin::EncoderProperties;
using Motor = twin::MotorData;

constexpr double micrometres_in_a_millimetre = 1000;
constexpr double millidegrees_in_a_degree = 1000;
constexpr double microseconds_in_a_millisecond = 1000;
constexpr double microsteps_in_a_degree = twin::microsteps_per_turn / 360.0;

constexpr std::string_view contact_kinds[] = {"normally closed", "normally open"};

struct Range {
  double lowest;
  double highest;
};

// ---- Rows of a kind: a member of `Target` that is given in some unit

template <class Target>
constexpr Key<Target> number(std::string_view name, std::string_view unit, Range range, std::string_view description,
                             void (*store)(Target& target, Value&& value)) {
  return {.name = name,
          .type = ValueType::number,
          .description = description,
          .store = store,
          .unit = unit,
          .lowest = range.lowest,
          .highest = range.highest};
}

template <auto member, class Target>
void store_micrometres(Target& target, Value&& value) {
  target.*member = static_cast<std::int32_t>(std::lround(value.number * micrometres_in_a_millimetre));
}

/// Half of it lies on either side of its middle.
template <auto member, class Target>
void store_even_micrometres(Target& target, Value&& value) {
  target.*member = 2 * static_cast<std::int32_t>(std::lround(value.number * micrometres_in_a_millimetre / 2));
}

template <auto member, class Target>
void store_millidegrees(Target& target, Value&& value) {
  target.*member = static_cast<std::int32_t>(std::lround(value.number * millidegrees_in_a_degree));
}

template <auto member, class Target>
void store_even_millidegrees(Target& target, Value&& value) {
  target.*member = 2 * static_cast<std::int32_t>(std::lround(value.number * millidegrees_in_a_degree / 2));
}

template <auto member, class Target>
void store_microseconds(Target& target, Value&& value) {
  target.*member = static_cast<std::int32_t>(std::lround(value.number * microseconds_in_a_millisecond));
}

template <auto member, class Target>
void store_real(Target& target, Value&& value) {
  target.*member = value.number;
}

std::int32_t microsteps_of(double degrees) {
  return static_cast<std::int32_t>(std::lround(degrees * microsteps_in_a_degree));
}

template <auto member, class Target>
constexpr Key<Target> whole(std::string_view name, Range range, std::string_view description) {
  return {.name = name,
          .type = ValueType::whole,
          .description = description,
          .store = [](Target& target,
                      Value&& value) { target.*member = static_cast<std::int32_t>(std::lround(value.number)); },
          .lowest = range.lowest,
          .highest = range.highest};
}

template <auto member, class Target>
constexpr Key<Target> truth(std::string_view name, std::string_view description) {
  return {
      .name = name, .type = ValueType::truth, .description = description, .store = [](Target& target, Value&& value) {
        target.*member = value.truth;
      }};
}

template <class Target>
constexpr Key<Target> contact(std::string_view description) {
  return {.name = "contact",
          .type = ValueType::choice,
          .description = description,
          .store =
              [](Target& target, Value&& value) {
                const bool is_open = value.text == contact_kinds[1];
                target.contact = is_open ? twin::Contact::normally_open : twin::Contact::normally_closed;
              },
          .choices = contact_kinds};
}

constexpr Key<Encoder> only_for(const ModuleDescription& module, Key<Encoder> key) {
  key.only_for = &module;
  return key;
}

// ---- The tables

constexpr Key<Stage> linear_stage[] = {
    number<Stage>("pitch", "mm", {0.1, 100}, "Way of the slider in a turn of the shaft.",
                  store_micrometres<&Stage::pitch>),
    number<Stage>("travel", "mm", {1, 2'000}, "From one hard end to the other.",
                  store_even_micrometres<&Stage::travel>),
    number<Stage>("start", "mm", {-1'000, 1'000}, "Where the slider stands in the beginning, from the middle.",
                  store_micrometres<&Stage::start>),
    truth<&Stage::mirrored, Stage>("mirrored",
                                   "The motor sits at the other end: positive angles move the slider to the left."),
    number<Stage>("limit_switch_distance", "mm", {0, 1'000},
                  "From a hard end to where the switch closest to it begins.",
                  store_micrometres<&Stage::limit_switch_distance>),
    number<Stage>("limit_switch_width", "mm", {0, 1'000}, "Way on which the slider holds a limit switch.",
                  store_micrometres<&Stage::limit_switch_width>),
    number<Stage>("home_switch_center", "mm", {-1'000, 1'000}, "Middle of the home switch.",
                  store_micrometres<&Stage::home_switch_center>),
    number<Stage>("home_switch_width", "mm", {0, 1'000}, "Way on which the slider holds the home switch.",
                  store_even_micrometres<&Stage::home_switch_width>),
    contact<Stage>("Kind of the three switches."),
    number<Stage>("switch_hysteresis", "mm", {0, 10}, "A switch that is held lets go so much further out.",
                  store_micrometres<&Stage::switch_hysteresis>),
    number<Stage>("switch_bounce", "ms", {0, 1'000}, "A contact chatters for so long after each change.",
                  store_microseconds<&Stage::switch_bounce>),
    number<Stage>("backlash", "mm", {0, 10}, "Way that the slider does not move when the shaft turns back.",
                  store_micrometres<&Stage::backlash>),
    number<Stage>("moved_mass", "kg", {0, 1'000}, "Slider and what is on it.", store_real<&Stage::moved_mass>),
    number<Stage>("screw_inertia", "kg m2", {0, 1}, "Screw and coupling.", store_real<&Stage::screw_inertia>),
    number<Stage>("friction", "N", {0, 10'000}, "Of the slider, the same at every speed.",
                  store_real<&Stage::friction>),
    number<Stage>("end_stiffness", "N/m", {1e3, 1e12}, "Of an end and of the screw's bearing together.",
                  store_real<&Stage::end_stiffness>),
};

constexpr Key<Table> circular_axis[] = {
    whole<&Table::gear_numerator, Table>("gear_numerator", {1, 10'000}, "The motor makes so many turns ..."),
    whole<&Table::gear_denominator, Table>("gear_denominator", {1, 10'000}, "... while the table makes this many."),
    number<Table>("start", "deg", {-360, 360}, "Where the table stands in the beginning.",
                  store_millidegrees<&Table::start>),
    truth<&Table::mirrored, Table>("mirrored", "The gear turns the direction round."),
    number<Table>("home_mark_center", "deg", {-360, 360}, "Middle of the home mark.",
                  store_millidegrees<&Table::home_mark_center>),
    number<Table>("home_mark_width", "deg", {0, 180}, "Angle in which the mark holds the home switch.",
                  store_even_millidegrees<&Table::home_mark_width>),
    contact<Table>("Kind of the home switch."),
    number<Table>("switch_hysteresis", "deg", {0, 10}, "The switch lets go so much further out.",
                  store_millidegrees<&Table::switch_hysteresis>),
    number<Table>("switch_bounce", "ms", {0, 1'000}, "The contact chatters for so long after each change.",
                  store_microseconds<&Table::switch_bounce>),
    number<Table>("backlash", "deg", {0, 10}, "Angle that the table does not move when the shaft turns back.",
                  store_millidegrees<&Table::backlash>),
    number<Table>("table_inertia", "kg m2", {0, 100}, "Of the table and what is on it.",
                  store_real<&Table::table_inertia>),
    number<Table>("gear_inertia", "kg m2", {0, 1}, "Of the gear, at the motor's shaft.",
                  store_real<&Table::gear_inertia>),
    number<Table>("friction", "Nm", {0, 1'000}, "At the table, the same at every speed.", store_real<&Table::friction>),
};

constexpr Key<Shaft> rotary_axis[] = {
    number<Shaft>("inertia", "kg m2", {0, 1}, "Of what is mounted on the shaft.", store_real<&Shaft::inertia>),
    number<Shaft>("friction", "Nm", {0, 1'000}, "The same at every speed.", store_real<&Shaft::friction>),
};

/// Amplitudes are so limited that the measured angle still only rises (EncoderProperties::Harmonic).
constexpr Key<Encoder> encoder[] = {
    truth<&Encoder::on_load_side, Encoder>("on_load_side", "Behind the backlash, not on the motor's shaft."),
    truth<&Encoder::reversed, Encoder>("reversed", "Counts down when the shaft angle rises."),
    only_for(tmcm1110, whole<&Encoder::lines, Encoder>("lines", {1, 100'000}, "Lines a turn, four counts each.")),
    only_for(tmcm1110, whole<&Encoder::null_position, Encoder>("null_position", {0, 399'999},
                                                               "Count at which N begins, less than a turn.")),
    only_for(tmcm1110, whole<&Encoder::null_width, Encoder>("null_width", {1, 399'999},
                                                            "Counts for which N lasts, less than a turn.")),
    only_for(tmcm1110, truth<&Encoder::null_level, Encoder>("null_level", "Level of N there.")),
    only_for(pd1161, number<Encoder>(
                         "magnet_offset", "deg", {-360, 360}, "Angle of the magnet's null below that of the shaft.",
                         [](Encoder& target, Value&& value) { target.magnet_offset = microsteps_of(value.number); })),
    only_for(pd1161, number<Encoder>("first_harmonic", "deg", {0, 20}, "Error of a magnet off its axis.",
                                     [](Encoder& target, Value&& value) {
                                       target.first_harmonic.amplitude = microsteps_of(value.number);
                                     })),
    only_for(pd1161, number<Encoder>("first_harmonic_phase", "deg", {-360, 360}, "Where that error is.",
                                     [](Encoder& target, Value&& value) {
                                       target.first_harmonic.phase = microsteps_of(value.number);
                                     })),
    only_for(pd1161, number<Encoder>("second_harmonic", "deg", {0, 15}, "Error of a magnet that is not round.",
                                     [](Encoder& target, Value&& value) {
                                       target.second_harmonic.amplitude = microsteps_of(value.number);
                                     })),
    only_for(pd1161, number<Encoder>("second_harmonic_phase", "deg", {-360, 360}, "Where that error is.",
                                     [](Encoder& target, Value&& value) {
                                       target.second_harmonic.phase = microsteps_of(value.number);
                                     })),
};

/// With the ranges of twin/motors/motor_table.py.
constexpr Key<Motor> motor[] = {
    number<Motor>("rated_current", "A", {0.05, 20}, "In each coil of a moving motor, rms.",
                  store_real<&Motor::rated_current>),
    number<Motor>("winding_resistance", "Ohm", {0.02, 200}, "Of one coil at 20 degC.",
                  store_real<&Motor::winding_resistance>),
    number<Motor>("winding_inductance", "H", {1e-5, 0.5}, "Of one coil.", store_real<&Motor::winding_inductance>),
    number<Motor>("holding_torque", "Nm", {0.005, 50}, "At the rated current.", store_real<&Motor::holding_torque>),
    number<Motor>("detent_torque", "Nm", {0, 5}, "Amplitude without current.", store_real<&Motor::detent_torque>),
    number<Motor>("rotor_inertia", "kg m2", {1e-8, 1e-2}, "Of the rotor alone.", store_real<&Motor::rotor_inertia>),
    number<Motor>("viscous_friction", "Nm s", {0, 0.1}, "Of the bearings: torque for 1 rad/s.",
                  store_real<&Motor::viscous_friction>),
    number<Motor>("coulomb_friction", "Nm", {0, 1}, "Of the bearings, the same at every speed.",
                  store_real<&Motor::coulomb_friction>),
    number<Motor>("eddy_damping", "Nm s", {0, 0.1}, "Against the speed of the rotor relative to the field.",
                  store_real<&Motor::eddy_damping>),
    number<Motor>("winding_time_constant", "s", {10, 1e5}, "Of the winding's temperature.",
                  store_real<&Motor::winding_time_constant>),
};

}  // namespace

std::span<const Key<Motor>> motor_keys() {
  return motor;
}

std::span<const Key<Stage>> linear_stage_keys() {
  return linear_stage;
}

std::span<const Key<Table>> circular_axis_keys() {
  return circular_axis;
}

std::span<const Key<Shaft>> rotary_axis_keys() {
  return rotary_axis;
}

std::span<const Key<Encoder>> encoder_keys() {
  return encoder;
}

}  // namespace opentmcl::scenario
