// From a number to its row in constant time, with tables of bytes derived at compile time. Only what the firmware
// needs is copied out of the rows, so that names and descriptions stay out of a microcontroller's flash.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"

namespace opentmcl {

inline constexpr std::uint8_t no_row = 255;

/// Row numbers by parameter, opcode or interrupt number.
struct RowIndex {
  std::uint8_t rows[256];

  constexpr std::uint8_t operator[](std::uint8_t number) const { return rows[number]; }
};

template <class Row, std::size_t count, class Number>
consteval RowIndex make_row_index(const Row (&table)[count], Number number) {
  static_assert(count < no_row);
  RowIndex index{};
  for (std::uint8_t& row : index.rows) row = no_row;
  for (std::size_t row = 0; row < count; ++row) {
    index.rows[static_cast<std::uint8_t>(number(table[row]))] = static_cast<std::uint8_t>(row);
  }
  return index;
}

inline constexpr RowIndex axis_parameter_rows =
    make_row_index(axis_parameters, [](const AxisParameterSpec& row) { return row.number; });
inline constexpr RowIndex global_parameter_rows =
    make_row_index(global_parameters, [](const GlobalParameterSpec& row) { return row.number; });
inline constexpr RowIndex interrupt_rows =
    make_row_index(interrupts, [](const InterruptSpec& row) { return row.number; });

constexpr std::size_t row_of(AxisParameter parameter) {
  return axis_parameter_rows[static_cast<std::uint8_t>(parameter)];
}
constexpr std::size_t row_of(GlobalParameter parameter) {
  return global_parameter_rows[static_cast<std::uint8_t>(parameter)];
}
constexpr std::size_t row_of(Interrupt interrupt) {
  return interrupt_rows[static_cast<std::uint8_t>(interrupt)];
}

/// The columns of one module, in the order of the rows.
template <std::size_t count>
struct ParameterColumns {
  ParameterColumn rows[count];

  constexpr const ParameterColumn& operator[](std::size_t row) const { return rows[row]; }
};

template <class Row, std::size_t count>
consteval ParameterColumns<count> columns_of(const Row (&table)[count], ModuleId module) {
  ParameterColumns<count> columns{};
  for (std::size_t row = 0; row < count; ++row) columns.rows[row] = table[row].in(module);
  return columns;
}

inline constexpr ParameterColumns<axis_parameter_count> axis_parameter_columns[module_count] = {
    columns_of(axis_parameters, ModuleId::tmcm1110), columns_of(axis_parameters, ModuleId::pd1161)};
inline constexpr ParameterColumns<global_parameter_count> global_parameter_columns[module_count] = {
    columns_of(global_parameters, ModuleId::tmcm1110), columns_of(global_parameters, ModuleId::pd1161)};

/// The columns of the interrupt table that the firmware needs.
struct InterruptColumn {
  InterruptSetting setting;
  Modules modules;
};

struct InterruptColumns {
  InterruptColumn rows[interrupt_count];

  constexpr const InterruptColumn& operator[](std::size_t row) const { return rows[row]; }
};

consteval InterruptColumns make_interrupt_columns() {
  InterruptColumns columns{};
  for (std::size_t row = 0; row < interrupt_count; ++row) {
    columns.rows[row] = {interrupts[row].setting, interrupts[row].modules};
  }
  return columns;
}

inline constexpr InterruptColumns interrupt_columns = make_interrupt_columns();

/// The row of an interrupt that `module` has, or no_row.
constexpr std::uint8_t interrupt_row_in(ModuleId module, std::uint8_t number) {
  const std::uint8_t row = interrupt_rows[number];
  return row != no_row && contains(interrupt_columns[row].modules, module) ? row : no_row;
}

/// A module that has no identifier for requests has no CAN.
constexpr bool has_can(ModuleId module) {
  return global_parameter_columns[static_cast<std::size_t>(module)][row_of(GlobalParameter::can_id)].access !=
         Access::none;
}

}  // namespace opentmcl
