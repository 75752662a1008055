// The commands over which direct mode is measured: what a host that moves a motor and watches it sends, and two
// mistakes.
#pragma once

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/lookup.hpp"
#include "firmware/spec/status_codes.hpp"
#include "firmware/tmcl/dispatch.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::bench {

struct MixedCommand {
  const char* name;
  Command command;
  Status expected;  ///< status of the reply: what fails early by accident would be measured as fast
};

constexpr Command command_of(Opcode opcode, std::uint8_t type, std::int32_t value) {
  return {static_cast<std::uint8_t>(opcode), type, 0, value};
}
constexpr Command get(AxisParameter parameter) {
  return command_of(Opcode::gap, static_cast<std::uint8_t>(parameter), 0);
}
constexpr Command set(AxisParameter parameter, std::int32_t value) {
  return command_of(Opcode::sap, static_cast<std::uint8_t>(parameter), value);
}

inline constexpr std::uint8_t no_opcode = 200;
inline constexpr std::uint8_t no_parameter = 99;
static_assert(instruction_rows[no_opcode] == no_row && axis_parameter_rows[no_parameter] == no_row);

inline constexpr MixedCommand direct_mode_mix[] = {
    {"GAP 1", get(AxisParameter::actual_position), Status::ok},
    {"GAP 3", get(AxisParameter::actual_speed), Status::ok},
    {"GAP 8", get(AxisParameter::position_reached), Status::ok},
    {"GAP 4", get(AxisParameter::maximum_positioning_speed), Status::ok},
    {"GAP 140", get(AxisParameter::microstep_resolution), Status::ok},
    {"GAP 10", get(AxisParameter::right_limit_switch_state), Status::ok},
    {"GAP 206", get(AxisParameter::actual_load_value), Status::ok},
    {"SAP 4", set(AxisParameter::maximum_positioning_speed, 1500), Status::ok},
    {"SAP 140", set(AxisParameter::microstep_resolution, 6), Status::ok},
    {"SAP 6", set(AxisParameter::maximum_current, 200), Status::ok},
    {"MVP ABS", command_of(Opcode::mvp, 0, 51200), Status::ok},
    {"ROR", command_of(Opcode::ror, 0, 1000), Status::ok},
    {"MST", command_of(Opcode::mst, 0, 0), Status::ok},
    {"136 binary", command_of(Opcode::get_firmware_version, 1, 0), Status::ok},
    {"invalid opcode", command_of(static_cast<Opcode>(no_opcode), 0, 0), Status::invalid_command},
    {"invalid parameter", command_of(Opcode::gap, no_parameter, 0), Status::wrong_type},
};

inline constexpr std::size_t direct_mode_mix_size = sizeof direct_mode_mix / sizeof direct_mode_mix[0];

}  // namespace opentmcl::bench
