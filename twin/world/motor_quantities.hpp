// Rows of quantities.cpp: the motor, its load and its coils.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>
#include <variant>

#include "twin/physics/shaft.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::twin::motor_rows {

using Kind = Quantity::Kind;

inline constexpr double degrees_a_turn = 360;
/// Of the shaft, in an electrical turn.
inline constexpr double shaft_degrees = degrees_a_turn / MotorData::pole_pairs;
inline constexpr double seconds_a_minute = 60;
inline constexpr double full_steps_an_electrical_turn = 4;

/// The motor as it is now. Only where there is one.
inline MotorShaft motor_in(const World& world) {
  return world.present_motor().value();
}

/// How far the field is ahead of the rotor, in electrical turns.
inline double lead(const World& world) {
  const auto motor = world.present_motor();
  const double rotor = motor ? motor->state().angle : electrical_turns_at(world.rotor_angle());
  return world.present_field().angle - rotor;
}

/// The motor model calls that coil its first which the driver's cosine feeds: coil B.
inline MotorShaft::Currents motor_currents(const World& world) {
  return motor_in(world).currents(world.present_field());
}

template <auto member, class Value>
void set_load(World& world, Value value) {
  Load load = world.load();
  load.*member = value;
  world.set_load(load);
}

// ---- Rows of a kind

struct Range {
  double lowest;
  double highest;
};

/// Something that acts on the shaft.
template <double Load::*member>
constexpr Quantity load_row(std::string_view name, std::string_view unit, Range range, std::string_view description) {
  return {.name = name,
          .unit = unit,
          .description = description,
          .needs_motor = true,
          .lowest = range.lowest,
          .highest = range.highest,
          .read = [](const World& world) { return world.load().*member; },
          .write = [](World& world, double value) { set_load<member>(world, value); }};
}

/// A pull at a machine of this kind, as what it is at the shaft.
template <class Dimensions>
constexpr Quantity pull_row(std::string_view name, std::string_view unit, Range range, std::string_view description) {
  return {
      .name = name,
      .unit = unit,
      .description = description,
      .needs_motor = true,
      .lowest = range.lowest,
      .highest = range.highest,
      .read = [](const World& world) { return world.load().torque / world.machine().torque_of(1); },
      .write = [](World& world, double value) { set_load<&Load::torque>(world, world.machine().torque_of(value)); },
      .exists = [](const World& world) { return std::holds_alternative<Dimensions>(world.machine().dimensions()); }};
}

template <Tmc262::Coil coil>
constexpr Quantity connected_row(std::string_view name, std::string_view description) {
  return {.name = name,
          .unit = "",
          .description = description,
          .kind = Kind::truth,
          .highest = 1,
          .read = [](const World& world) { return world.tmc262().coil_connected(coil) ? 1.0 : 0.0; },
          .write = [](World& world, double value) { world.set_coil_connected(coil, value != 0); }};
}

template <Tmc262::Coil coil>
constexpr Quantity shorted_row(std::string_view name, std::string_view description) {
  return {.name = name,
          .unit = "",
          .description = description,
          .kind = Kind::truth,
          .highest = 1,
          .read = [](const World& world) { return world.tmc262().shorted_to_ground(coil) ? 1.0 : 0.0; },
          .write = [](World& world, double value) { world.set_short_to_ground(coil, value != 0); }};
}

// ---- The table

inline constexpr Quantity rows[] = {
    // ---- What acts on the shaft
    load_row<&Load::torque>("load.torque", "Nm", {-10, 10},
                            "Constant torque at the shaft, against positive motion when positive."),
    pull_row<LinearStageDimensions>("load.pull", "N", {-10'000, 10'000},
                                    "load.torque as the force that pulls the slider to the left."),
    pull_row<CircularAxisDimensions>("load.table_torque", "Nm", {-1'000, 1'000},
                                     "load.torque as the torque that turns the table back."),
    load_row<&Load::inertia>("load.inertia", "kg m2", {0, 1}, "Of all that is on the shaft, without the rotor."),
    load_row<&Load::coulomb_friction>("load.coulomb_friction", "Nm", {0, 10},
                                      "Friction of all that is on the shaft, the same at every speed."),
    load_row<&Load::viscous_friction>("load.viscous_friction", "Nm s", {0, 1},
                                      "Friction that rises with the speed: torque for 1 rad/s."),
    load_row<&Load::spring>("load.spring", "Nm/rad", {0, 1'000}, "A spring that pulls the shaft to its centre."),
    {.name = "load.spring_centre",
     .unit = "deg",
     .description = "Angle of the shaft at which the spring is at rest.",
     .needs_motor = true,
     .lowest = -1e6,
     .highest = 1e6,
     .read = [](const World& world) { return world.load().spring_centre * shaft_degrees; },
     .write = [](World& world, double value) { set_load<&Load::spring_centre>(world, value / shaft_degrees); }},
    {.name = "load.jammed",
     .unit = "",
     .description = "Something holds the shaft where it is.",
     .kind = Kind::truth,
     .needs_motor = true,
     .highest = 1,
     .read = [](const World& world) { return world.load().jammed ? 1.0 : 0.0; },
     .write = [](World& world, double value) { set_load<&Load::jammed>(world, value != 0); }},
    {.name = "load_measurement",
     .unit = "",
     .description = "What stallGuard2 measures of the load with SGT = 0: 0 is a stall, 1023 no load. Less than 0 is "
                    "seen by SGT > 0 alone.",
     .kind = Kind::whole,
     .set_by_motor = true,
     .lowest = -tmc262::maximum_stall_guard_value,
     .highest = tmc262::maximum_stall_guard_value,
     .read =
         [](const World& world) {
           const auto motor = world.present_motor();
           return static_cast<double>(motor ? motor->stall_guard_measurement() : world.load_measurement());
         },
     .write = [](World& world,
                 double value) { world.set_load_measurement(static_cast<std::int32_t>(std::lround(value))); }},
    // ---- The rotor
    {.name = "rotor.angle",
     .unit = "deg",
     .description = "Angle of the shaft since power-on, over all turns.",
     .read =
         [](const World& world) {
           return static_cast<double>(world.rotor_angle()) * degrees_a_turn / static_cast<double>(microsteps_per_turn);
         }},
    {.name = "rotor.microsteps",
     .unit = "",
     .description = "The same angle in microsteps of 1/256 full step.",
     .kind = Kind::whole,
     .read = [](const World& world) { return static_cast<double>(world.rotor_angle()); }},
    {.name = "rotor.speed",
     .unit = "rpm",
     .description = "Turns of the shaft in a minute, negative to the left.",
     .needs_motor = true,
     .read =
         [](const World& world) {
           return motor_in(world).state().velocity / MotorData::pole_pairs * seconds_a_minute;
         }},
    {.name = "rotor.load_angle",
     .unit = "deg",
     .description =
         "Electrical angle of the field ahead of the rotor, -180 to 180; the torque is greatest at about 90.",
     .needs_motor = true,
     .read =
         [](const World& world) {
           const double turns = lead(world);
           return (turns - std::round(turns)) * degrees_a_turn;
         }},
    {.name = "rotor.lost_steps",
     .unit = "",
     .description = "Full steps by which the rotor has fallen behind the field: whole electrical turns, four each.",
     .kind = Kind::whole,
     .read = [](const World& world) { return full_steps_an_electrical_turn * std::round(lead(world)); }},
    {.name = "rotor.regime",
     .unit = "",
     .description = "How the rotor is computed: 0 locked to the field, 1 free, 2 slipping.",
     .kind = Kind::whole,
     .needs_motor = true,
     .read = [](const World& world) { return static_cast<double>(motor_in(world).regime()); }},
    // ---- The motor
    {.name = "motor.torque",
     .unit = "Nm",
     .description = "Torque of the field on the rotor; the mean while the rotor is locked.",
     .needs_motor = true,
     .read = [](const World& world) { return motor_in(world).effort().torque; }},
    {.name = "motor.pull_out_torque",
     .unit = "Nm",
     .description = "The most that the field could give at this speed, current and supply.",
     .needs_motor = true,
     .read = [](const World& world) { return motor_in(world).effort().pull_out_torque; }},
    {.name = "motor.winding_temperature",
     .unit = "degC",
     .description = "Of the copper, which the current warms; a warm winding has more resistance.",
     .needs_motor = true,
     .read = [](const World& world) { return motor_in(world).winding_temperature(); }},
    {.name = "motor.ambient_temperature",
     .unit = "degC",
     .description = "Around the motor; its winding goes there in the time constant of its data.",
     .needs_motor = true,
     .lowest = -40,
     .highest = 200,
     .read = [](const World& world) { return motor_in(world).ambient(); },
     .write = [](World& world, double value) { world.set_ambient_temperature(value); }},
    {.name = "coil_a.current",
     .unit = "A",
     .description = "Current in coil A.",
     .needs_motor = true,
     .read = [](const World& world) { return motor_currents(world).b; }},
    {.name = "coil_b.current",
     .unit = "A",
     .description = "Current in coil B.",
     .needs_motor = true,
     .read = [](const World& world) { return motor_currents(world).a; }},
    connected_row<Tmc262::Coil::a>("coil_a.connected", "The wires to coil A are whole."),
    connected_row<Tmc262::Coil::b>("coil_b.connected", "The wires to coil B are whole."),
    shorted_row<Tmc262::Coil::a>("coil_a.shorted", "One end of coil A touches ground."),
    shorted_row<Tmc262::Coil::b>("coil_b.shorted", "One end of coil B touches ground."),
};

}  // namespace opentmcl::twin::motor_rows
