#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/motion/axis.hpp"
#include "firmware/param/parameter_store.hpp"
#include "firmware/spec/lookup.hpp"
#include "firmware/spec/status_codes.hpp"

namespace opentmcl {

/// Global parameters of banks 0, 2 and 3, and the coordinates: values in RAM, rules of the tables, copies in the
/// EEPROM. The live parameters of bank 0 (program state, tick timer, random number) are the executor's.
class GlobalParameterAccess {
 public:
  GlobalParameterAccess(const ModuleDescription& module, Axis& axis, ParameterStore& store);

  /// @return ok, wrong_type (no such parameter) or invalid_value (no such bank)
  Status get(std::uint8_t number, std::uint8_t bank, std::int32_t& value) const;
  /// @return as get(), or wrong_type (read only), invalid_value (out of range), eeprom_locked
  Status set(std::uint8_t number, std::uint8_t bank, std::int32_t value);
  /// User variables 0 to 55; of bank 0 those that are stored anyway. @return ok, wrong_type, invalid_value (no such
  /// bank) or eeprom_locked
  Status store(std::uint8_t number, std::uint8_t bank);
  /// @return as store()
  Status restore(std::uint8_t number, std::uint8_t bank);

  /// Is the access to a number of bank 0 allowed, and the value in its range?
  Status check(std::uint8_t number, Access access, std::int32_t value = 0) const;

  std::int32_t operator[](GlobalParameter parameter) const { return values_[row_of(parameter)]; }

  std::int32_t variable(std::uint8_t number) const { return variables_[number]; }
  void set_variable(std::uint8_t number, std::int32_t value) { variables_[number] = value; }

  /// @param number less than coordinate_count
  std::int32_t coordinate(std::uint8_t number) const { return coordinates_[number]; }
  /// Stores it as well when global parameter 84 says so. @return ok or eeprom_locked
  Status set_coordinate(std::uint8_t number, std::int32_t position);
  /// @param number one coordinate, or 0 for all but coordinate 0. @return ok or eeprom_locked
  Status store_coordinates(std::uint8_t number);
  void restore_coordinates(std::uint8_t number);

  /// Global parameter 73: nothing may be stored.
  bool is_locked() const { return (*this)[GlobalParameter::eeprom_lock] != 0; }

  /// Global parameter 81: the program may not be read, and is erased before it may.
  bool hides_program() const { return ((*this)[GlobalParameter::code_protection] & 1) != 0; }

  /// Setting of an interrupt (bank 3) by row of the interrupt table.
  std::int32_t interrupt_setting(std::size_t row) const { return interrupt_settings_[row]; }

  /// Puts bank 0 back to its defaults; variables and coordinates to 0. The EEPROM is the store's affair.
  void restore_defaults();
  /// Takes over what the EEPROM holds, for the start.
  void load_stored();

  Axis::Wiring wiring() const;

 private:
  static std::uint8_t variable_slot(std::uint8_t number) {
    return static_cast<std::uint8_t>(eeprom_layout::first_user_variable_slot + number);
  }
  static std::uint8_t coordinate_slot(std::uint8_t number) {
    return static_cast<std::uint8_t>(eeprom_layout::first_coordinate_slot + number - 1);
  }
  Status set_in_bank_0(std::uint8_t number, std::int32_t value);
  std::uint8_t interrupt_row(std::uint8_t number) const;
  std::int32_t stored_or_zero(std::uint8_t slot) const { return store_.holds(slot) ? store_.value(slot) : 0; }

  ModuleId module_;
  const ParameterColumns<global_parameter_count>& columns_;
  Axis& axis_;
  ParameterStore& store_;
  std::int32_t values_[global_parameter_count];
  std::int32_t variables_[user_variable_count] = {};
  std::int32_t coordinates_[coordinate_count] = {};
  std::int32_t interrupt_settings_[interrupt_count] = {};
};

}  // namespace opentmcl
