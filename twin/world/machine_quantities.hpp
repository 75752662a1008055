// Rows of quantities.cpp: what the shaft moves, and its switches and encoder.
#pragma once

#include <string_view>
#include <variant>

#include "twin/world/quantities.hpp"

namespace opentmcl::twin::machine_rows {

using Kind = Quantity::Kind;

inline constexpr double micrometres = 1000;   // in 1 mm
inline constexpr double millidegrees = 1000;  // in 1 degree

// ---- Rows of a kind

template <class Dimensions>
bool is_machine(const World& world) {
  return std::holds_alternative<Dimensions>(world.machine().dimensions());
}

template <MachineSwitch source, void (World::*cut_wire)(bool)>
constexpr Quantity held_open_row(std::string_view name, std::string_view description) {
  return {.name = name,
          .unit = "",
          .description = description,
          .kind = Kind::truth,
          .highest = 1,
          .read = [](const World& world) { return world.machine().wire_broken(source) ? 1.0 : 0.0; },
          .write = [](World& world, double value) { (world.*cut_wire)(value != 0); }};
}

template <MachineSwitch source>
constexpr Quantity pressed_row(std::string_view name, std::string_view description) {
  return {.name = name,
          .unit = "",
          .description = description,
          .kind = Kind::truth,
          .highest = 1,
          .read = [](const World& world) { return world.machine().pressed(source) ? 1.0 : 0.0; },
          .write = [](World& world, double value) { world.press_switch(source, value != 0); },
          .exists = [](const World& world) { return world.machine().has_switch(source); }};
}

template <EncoderChannel channel>
constexpr Quantity encoder_wire_row(std::string_view name, std::string_view description) {
  return {.name = name,
          .unit = "",
          .description = description,
          .kind = Kind::truth,
          .highest = 1,
          .read = [](const World& world) { return world.encoder().wire_broken(channel) ? 0.0 : 1.0; },
          .write = [](World& world, double value) { world.break_encoder_wire(channel, value == 0); },
          .exists =
              [](const World& world) { return world.encoder().properties().kind == ShaftEncoder::Kind::incremental; }};
}

// ---- The table

inline constexpr Quantity rows[] = {
    {.name = "stage",
     .unit = "mm",
     .description = "Place of the slider from the middle of its travel.",
     .trace_scale = micrometres,
     .follows_rotor = true,
     .read = [](const World& world) { return static_cast<double>(world.place()) / micrometres; },
     .exists = is_machine<LinearStageDimensions>},
    {.name = "table",
     .unit = "deg",
     .description = "Angle of the table behind its gear, over all turns.",
     .read = [](const World& world) { return static_cast<double>(world.place()) / millidegrees; },
     .exists = is_machine<CircularAxisDimensions>},
    {.name = "encoder",
     .unit = "",
     .description = "Counts of the encoder since power-on; 1024 a turn of the shaft unless told otherwise.",
     .kind = Kind::whole,
     .trace_scale = 1,
     .follows_rotor = true,
     .read = [](const World& world) { return static_cast<double>(world.encoder_count()); }},
    {.name = "encoder.near_null",
     .unit = "",
     .description = "The shaft stands within 5 counts of the encoder's null position.",
     .kind = Kind::truth,
     .read = [](const World& world) { return world.encoder_near_null() ? 1.0 : 0.0; }},
    encoder_wire_row<EncoderChannel::a>("encoder.a_connected", "The wire of the encoder's channel A is whole."),
    encoder_wire_row<EncoderChannel::b>("encoder.b_connected", "The wire of the encoder's channel B is whole."),
    encoder_wire_row<EncoderChannel::n>("encoder.n_connected", "The wire of the encoder's channel N is whole."),
    {.name = "left_switch",
     .unit = "",
     .description = "Level at the input for the left limit switch; high while the contact is open.",
     .kind = Kind::truth,
     .trace_scale = 1,
     .read = [](const World& world) { return world.left_switch() ? 1.0 : 0.0; }},
    held_open_row<MachineSwitch::left, &World::set_left_switch>(
        "left_switch.held_open", "The wire of the left limit switch is cut: its input is high."),
    pressed_row<MachineSwitch::left>("left_switch.pressed",
                                     "A finger holds the left limit switch as the machine would."),
    {.name = "right_switch",
     .unit = "",
     .description = "Level at the input for the right limit switch; high while the contact is open.",
     .kind = Kind::truth,
     .trace_scale = 1,
     .read = [](const World& world) { return world.right_switch() ? 1.0 : 0.0; }},
    held_open_row<MachineSwitch::right, &World::set_right_switch>(
        "right_switch.held_open", "The wire of the right limit switch is cut: its input is high."),
    pressed_row<MachineSwitch::right>("right_switch.pressed",
                                      "A finger holds the right limit switch as the machine would."),
    {.name = "home_switch",
     .unit = "",
     .description = "Level at the input for the home switch; high while the contact is open.",
     .kind = Kind::truth,
     .trace_scale = 1,
     .read = [](const World& world) { return world.home_switch() ? 1.0 : 0.0; }},
    held_open_row<MachineSwitch::home, &World::set_home_switch>(
        "home_switch.held_open", "The wire of the home switch is cut: its input is high."),
    pressed_row<MachineSwitch::home>("home_switch.pressed", "A finger holds the home switch as the machine would."),
};

}  // namespace opentmcl::twin::machine_rows
