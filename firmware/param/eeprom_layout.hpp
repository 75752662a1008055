// Where everything is in the 16 KiB EEPROM. Explicit and versioned: docs/eeprom.md describes the same bytes in prose.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/eeprom.hpp"
#include "firmware/spec/lookup.hpp"

namespace opentmcl::eeprom_layout {

inline constexpr std::uint8_t version = 2;

// ---- Header: two copies, each 16 bytes, in one page of their own ---------------------------------------------------
inline constexpr std::uint16_t header_copies[2] = {0, 32};
inline constexpr std::size_t header_size = 16;

// ---- Records: every setting has a slot, every slot two copies in different pages -----------------------------------
inline constexpr std::size_t record_size = 8;
inline constexpr std::size_t slot_count = 124;
inline constexpr std::uint16_t record_copies[2] = {64, 64 + slot_count* record_size};

constexpr std::uint16_t record_address(std::uint8_t slot, unsigned copy) {
  return static_cast<std::uint16_t>(record_copies[copy] + slot * record_size);
}

inline constexpr std::uint8_t first_axis_parameter_slot = 0;
inline constexpr std::uint8_t first_global_parameter_slot = 20;
inline constexpr std::uint8_t program_state_slot = 44;
inline constexpr std::uint8_t first_user_variable_slot = 48;
inline constexpr std::uint8_t first_coordinate_slot = 104;  // of coordinate 1; coordinate 0 is never stored

// ---- Program: 2048 instructions of 7 bytes -------------------------------------------------------------------------
inline constexpr std::uint16_t program_address = 2048;
inline constexpr std::size_t instruction_size = 7;

static_assert(record_copies[1] + slot_count * record_size <= program_address);
static_assert(program_address + 2048 * instruction_size == hal::Eeprom::size);
static_assert(first_user_variable_slot + stored_user_variable_count <= first_coordinate_slot);
static_assert(first_coordinate_slot + coordinate_count - 1 <= slot_count);

/// Slots of axis parameters: the order is the storage format, so new ones are added at the end.
inline constexpr AxisParameter axis_parameter_slots[] = {
    AxisParameter::maximum_positioning_speed,
    AxisParameter::maximum_acceleration,
    AxisParameter::maximum_current,
    AxisParameter::standby_current,
    AxisParameter::right_limit_switch_disable,
    AxisParameter::left_limit_switch_disable,
    AxisParameter::minimum_speed,
    AxisParameter::microstep_resolution,
    AxisParameter::soft_stop,
    AxisParameter::ramp_divisor,
    AxisParameter::pulse_divisor,
    AxisParameter::reference_search_mode,
    AxisParameter::reference_search_speed,
    AxisParameter::reference_switch_speed,
    AxisParameter::freewheeling_delay,
    AxisParameter::encoder_prescaler,
    AxisParameter::maximum_encoder_deviation,
    AxisParameter::power_down_delay,
    AxisParameter::step_direction_mode,
};
inline constexpr std::size_t axis_parameter_slot_count = sizeof axis_parameter_slots / sizeof axis_parameter_slots[0];

/// Slots of global parameters of bank 0, likewise.
inline constexpr GlobalParameter global_parameter_slots[] = {
    GlobalParameter::eeprom_magic,
    GlobalParameter::rs485_baud_rate,
    GlobalParameter::serial_address,
    GlobalParameter::ascii_mode,
    GlobalParameter::serial_heartbeat,
    GlobalParameter::can_bit_rate,
    GlobalParameter::can_reply_id,
    GlobalParameter::can_id,
    GlobalParameter::eeprom_lock,
    GlobalParameter::telegram_pause_time,
    GlobalParameter::serial_host_address,
    GlobalParameter::auto_start,
    GlobalParameter::io_direction,
    GlobalParameter::end_switch_polarity,
    GlobalParameter::code_protection,
    GlobalParameter::can_heartbeat,
    GlobalParameter::can_secondary_id,
    GlobalParameter::coordinate_storage,
    GlobalParameter::do_not_restore_user_variables,
    GlobalParameter::step_pulse_length,
    GlobalParameter::serial_secondary_address,
    GlobalParameter::reverse_shaft,
};
inline constexpr std::size_t global_parameter_slot_count =
    sizeof global_parameter_slots / sizeof global_parameter_slots[0];

static_assert(first_axis_parameter_slot + axis_parameter_slot_count <= first_global_parameter_slot);
static_assert(first_global_parameter_slot + global_parameter_slot_count <= program_state_slot);

/// Slot of the parameter in a row of its table, or no_row.
template <std::size_t rows>
struct SlotIndex {
  std::uint8_t slots[rows];
  constexpr std::uint8_t operator[](std::size_t row) const { return slots[row]; }
};

template <std::size_t rows, class Parameter, std::size_t count>
consteval SlotIndex<rows> make_slot_index(const Parameter (&order)[count], std::uint8_t first) {
  SlotIndex<rows> index{};
  for (std::uint8_t& slot : index.slots) slot = no_row;
  for (std::size_t i = 0; i < count; ++i) index.slots[row_of(order[i])] = static_cast<std::uint8_t>(first + i);
  return index;
}

inline constexpr auto axis_parameter_slot =
    make_slot_index<axis_parameter_count>(axis_parameter_slots, first_axis_parameter_slot);
inline constexpr auto global_parameter_slot =
    make_slot_index<global_parameter_count>(global_parameter_slots, first_global_parameter_slot);

/// Exactly the parameters that some module can store have a slot.
template <class Row, std::size_t count, std::size_t rows>
consteval bool every_stored_row_has_a_slot(const Row (&table)[count], const SlotIndex<rows>& slots, Access stored) {
  for (std::size_t row = 0; row < count; ++row) {
    bool is_stored = false;
    for (const ParameterColumn& column : table[row].columns) is_stored = is_stored || allows(column.access, stored);
    if (is_stored != (slots[row] != no_row)) return false;
  }
  return true;
}
static_assert(every_stored_row_has_a_slot(axis_parameters, axis_parameter_slot, Access::e));
static_assert(every_stored_row_has_a_slot(global_parameters, global_parameter_slot, Access::a));

}  // namespace opentmcl::eeprom_layout
