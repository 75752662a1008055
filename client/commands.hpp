// The commands of direct mode, typed: what `Client` and the asynchronous bus send. Source: PD-1161 manual 3.7.
#pragma once

#include <cstdint>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/io_ports.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::client::commands {

constexpr Command make(Opcode opcode, std::uint8_t type = 0, std::uint8_t motor = 0, std::int32_t value = 0) {
  return {static_cast<std::uint8_t>(opcode), type, motor, value};
}

/// The words of MVP and RFS, by their place in the tables.
inline constexpr std::uint8_t absolute = mvp_mode_words[0].value;
inline constexpr std::uint8_t relative = mvp_mode_words[1].value;
inline constexpr std::uint8_t to_coordinate = mvp_mode_words[2].value;

/// @param number axis parameter 0…255
constexpr Command get_axis_parameter(std::uint8_t number, std::uint8_t motor = 0) {
  return make(Opcode::gap, number, motor);
}
constexpr Command get_axis_parameter(AxisParameter parameter, std::uint8_t motor = 0) {
  return get_axis_parameter(static_cast<std::uint8_t>(parameter), motor);
}
constexpr Command set_axis_parameter(std::uint8_t number, std::int32_t value, std::uint8_t motor = 0) {
  return make(Opcode::sap, number, motor, value);
}
constexpr Command set_axis_parameter(AxisParameter parameter, std::int32_t value, std::uint8_t motor = 0) {
  return set_axis_parameter(static_cast<std::uint8_t>(parameter), value, motor);
}
/// To the EEPROM, from where it comes when the module is switched on.
constexpr Command store_axis_parameter(std::uint8_t number, std::uint8_t motor = 0) {
  return make(Opcode::stap, number, motor);
}
/// From the EEPROM.
constexpr Command restore_axis_parameter(std::uint8_t number, std::uint8_t motor = 0) {
  return make(Opcode::rsap, number, motor);
}

/// @param number global parameter or user variable 0…255
constexpr Command get_global_parameter(std::uint8_t number, Bank bank) {
  return make(Opcode::ggp, number, static_cast<std::uint8_t>(bank));
}
constexpr Command set_global_parameter(std::uint8_t number, Bank bank, std::int32_t value) {
  return make(Opcode::sgp, number, static_cast<std::uint8_t>(bank), value);
}
constexpr Command store_global_parameter(std::uint8_t number, Bank bank) {
  return make(Opcode::stgp, number, static_cast<std::uint8_t>(bank));
}
constexpr Command restore_global_parameter(std::uint8_t number, Bank bank) {
  return make(Opcode::rsgp, number, static_cast<std::uint8_t>(bank));
}

/// @param velocity internal units, -2047…2047; negative turns left
constexpr Command rotate(std::int32_t velocity, std::uint8_t motor = 0) {
  return velocity < 0 ? make(Opcode::rol, 0, motor, -velocity) : make(Opcode::ror, 0, motor, velocity);
}
/// @param position microsteps
constexpr Command move_to(std::int32_t position, std::uint8_t motor = 0) {
  return make(Opcode::mvp, absolute, motor, position);
}
/// @param distance microsteps from the actual position
constexpr Command move_by(std::int32_t distance, std::uint8_t motor = 0) {
  return make(Opcode::mvp, relative, motor, distance);
}
constexpr Command move_to_coordinate(std::uint8_t coordinate, std::uint8_t motor = 0) {
  return make(Opcode::mvp, to_coordinate, motor, coordinate);
}
constexpr Command stop(std::uint8_t motor = 0) {
  return make(Opcode::mst, 0, motor);
}

constexpr Command start_reference_search(std::uint8_t motor = 0) {
  return make(Opcode::rfs, rfs_action_words[0].value, motor);
}
constexpr Command stop_reference_search(std::uint8_t motor = 0) {
  return make(Opcode::rfs, rfs_action_words[1].value, motor);
}
/// The reply is 0 when no search is running.
constexpr Command reference_search_status(std::uint8_t motor = 0) {
  return make(Opcode::rfs, rfs_action_words[2].value, motor);
}

constexpr Command get_input_output(std::uint8_t port, IoBank bank) {
  return make(Opcode::gio, port, static_cast<std::uint8_t>(bank));
}
constexpr Command set_output(std::uint8_t port, IoBank bank, std::int32_t value) {
  return make(Opcode::sio, port, static_cast<std::uint8_t>(bank), value);
}

constexpr Command get_coordinate(std::uint8_t coordinate, std::uint8_t motor = 0) {
  return make(Opcode::gco, coordinate, motor);
}
constexpr Command set_coordinate(std::uint8_t coordinate, std::int32_t position, std::uint8_t motor = 0) {
  return make(Opcode::sco, coordinate, motor, position);
}
constexpr Command capture_coordinate(std::uint8_t coordinate, std::uint8_t motor = 0) {
  return make(Opcode::cco, coordinate, motor);
}

constexpr Command stop_application() {
  return make(Opcode::stop_application);
}
constexpr Command run_application() {
  return make(Opcode::run_application);
}
constexpr Command reset_application() {
  return make(Opcode::reset_application);
}

/// What command 135 can be asked for, by its type.
enum class ApplicationStatus : std::uint8_t {
  short_form = 0,
  with_program_counter = 1,
  accumulator = 2,
  x_register = 3
};
constexpr Command get_application_status(ApplicationStatus what) {
  return make(Opcode::get_application_status, static_cast<std::uint8_t>(what));
}

/// The reply's nine bytes are text.
constexpr Command get_firmware_version_text() {
  return make(Opcode::get_firmware_version, 0);
}
constexpr Command get_firmware_version() {
  return make(Opcode::get_firmware_version, 1);
}

/// No reply comes.
constexpr Command restore_factory_settings() {
  return make(Opcode::restore_factory_settings, 0, 0, confirmation_code);
}
/// No reply comes.
constexpr Command software_reset() {
  return make(Opcode::software_reset, 0, 0, confirmation_code);
}

}  // namespace opentmcl::client::commands
