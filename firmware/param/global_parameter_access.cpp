#include "firmware/param/global_parameter_access.hpp"

namespace opentmcl {

namespace layout = eeprom_layout;

namespace {

constexpr std::int32_t both_edges = 3;

}  // namespace

GlobalParameterAccess::GlobalParameterAccess(const ModuleDescription& module, Axis& axis, ParameterStore& store)
    : module_(module.id),
      columns_(global_parameter_columns[static_cast<std::size_t>(module.id)]),
      axis_(axis),
      store_(store) {
  restore_defaults();
}

void GlobalParameterAccess::restore_defaults() {
  for (std::size_t row = 0; row < global_parameter_count; ++row) values_[row] = columns_[row].default_value;
  for (std::int32_t& variable : variables_) variable = 0;
  for (std::int32_t& coordinate : coordinates_) coordinate = 0;
}

Status GlobalParameterAccess::check(std::uint8_t number, Access access, std::int32_t value) const {
  const std::uint8_t row = global_parameter_rows[number];
  if (row == no_row || !allows(columns_[row].access, access)) return Status::wrong_type;
  if (access == Access::w && (value < columns_[row].minimum || value > columns_[row].maximum)) {
    return Status::invalid_value;
  }
  return Status::ok;
}

std::uint8_t GlobalParameterAccess::interrupt_row(std::uint8_t number) const {
  const std::uint8_t row = interrupt_row_in(module_, number);
  return row != no_row && interrupt_columns[row].setting != InterruptSetting::none ? row : no_row;
}

Status GlobalParameterAccess::get(std::uint8_t number, std::uint8_t bank, std::int32_t& value) const {
  switch (static_cast<Bank>(bank)) {
    case Bank::module_settings: {
      const Status status = check(number, Access::r);
      if (status == Status::ok) value = values_[global_parameter_rows[number]];
      return status;
    }
    case Bank::user_variables:
      value = variables_[number];
      return Status::ok;
    case Bank::interrupt_settings: {
      const std::uint8_t row = interrupt_row(number);
      if (row == no_row) return Status::wrong_type;
      value = interrupt_settings_[row];
      return Status::ok;
    }
    default:
      return Status::invalid_value;
  }
}

Status GlobalParameterAccess::set(std::uint8_t number, std::uint8_t bank, std::int32_t value) {
  switch (static_cast<Bank>(bank)) {
    case Bank::module_settings:
      return set_in_bank_0(number, value);
    case Bank::user_variables:
      variables_[number] = value;
      return Status::ok;
    case Bank::interrupt_settings: {
      const std::uint8_t row = interrupt_row(number);
      if (row == no_row) return Status::wrong_type;
      const bool is_edge = interrupt_columns[row].setting == InterruptSetting::edge;
      if (is_edge && (value < 0 || value > both_edges)) return Status::invalid_value;
      interrupt_settings_[row] = value;
      return Status::ok;
    }
    default:
      return Status::invalid_value;
  }
}

Status GlobalParameterAccess::set_in_bank_0(std::uint8_t number, std::int32_t value) {
  const Status status = check(number, Access::w, value);
  if (status != Status::ok) return status;
  const auto parameter = static_cast<GlobalParameter>(number);
  if (parameter == GlobalParameter::eeprom_lock) {
    if (value != eeprom_lock_code && value != eeprom_unlock_code) return Status::invalid_value;
    value = value == eeprom_lock_code ? 1 : 0;
  } else if (is_locked() && check(number, Access::a) == Status::ok) {
    return Status::eeprom_locked;
  }
  const std::uint8_t row = global_parameter_rows[number];
  values_[row] = value;
  if (layout::global_parameter_slot[row] != no_row) store_.store(layout::global_parameter_slot[row], value);
  switch (parameter) {
    case GlobalParameter::end_switch_polarity:
    case GlobalParameter::step_pulse_length:
    case GlobalParameter::reverse_shaft:
      axis_.apply(wiring());
      break;
    default:
      break;
  }
  return Status::ok;
}

Status GlobalParameterAccess::store(std::uint8_t number, std::uint8_t bank) {
  switch (static_cast<Bank>(bank)) {
    case Bank::module_settings: {
      const Status status = check(number, Access::a);
      return status == Status::ok && is_locked() ? Status::eeprom_locked : status;
    }
    case Bank::user_variables:
      if (number >= stored_user_variable_count) return Status::wrong_type;
      if (is_locked()) return Status::eeprom_locked;
      store_.store(variable_slot(number), variables_[number]);
      return Status::ok;
    case Bank::interrupt_settings:
      return Status::wrong_type;
    default:
      return Status::invalid_value;
  }
}

Status GlobalParameterAccess::restore(std::uint8_t number, std::uint8_t bank) {
  switch (static_cast<Bank>(bank)) {
    case Bank::module_settings:
      return check(number, Access::a);
    case Bank::user_variables:
      if (number >= stored_user_variable_count) return Status::wrong_type;
      variables_[number] = stored_or_zero(variable_slot(number));
      return Status::ok;
    case Bank::interrupt_settings:
      return Status::wrong_type;
    default:
      return Status::invalid_value;
  }
}

Status GlobalParameterAccess::set_coordinate(std::uint8_t number, std::int32_t position) {
  const bool stored = number != 0 && (*this)[GlobalParameter::coordinate_storage] != 0;
  if (stored && is_locked()) return Status::eeprom_locked;
  coordinates_[number] = position;
  if (stored) store_.store(coordinate_slot(number), position);
  return Status::ok;
}

Status GlobalParameterAccess::store_coordinates(std::uint8_t number) {
  if (is_locked()) return Status::eeprom_locked;
  for (std::uint8_t n = 1; n < coordinate_count; ++n) {
    if (number == 0 || number == n) store_.store(coordinate_slot(n), coordinates_[n]);
  }
  return Status::ok;
}

void GlobalParameterAccess::restore_coordinates(std::uint8_t number) {
  for (std::uint8_t n = 1; n < coordinate_count; ++n) {
    if (number == 0 || number == n) coordinates_[n] = stored_or_zero(coordinate_slot(n));
  }
}

void GlobalParameterAccess::load_stored() {
  for (std::size_t row = 0; row < global_parameter_count; ++row) {
    const std::uint8_t slot = layout::global_parameter_slot[row];
    if (slot == no_row || !allows(columns_[row].access, Access::a) || !store_.holds(slot)) continue;
    const std::int32_t value = store_.value(slot);
    if (value >= columns_[row].minimum && value <= columns_[row].maximum) values_[row] = value;
  }
  if ((*this)[GlobalParameter::do_not_restore_user_variables] == 0) {
    for (std::uint8_t number = 0; number < stored_user_variable_count; ++number) {
      variables_[number] = stored_or_zero(variable_slot(number));
    }
  }
  if ((*this)[GlobalParameter::coordinate_storage] != 0) restore_coordinates(0);
}

Axis::Wiring GlobalParameterAccess::wiring() const {
  return {(*this)[GlobalParameter::reverse_shaft] != 0, (*this)[GlobalParameter::end_switch_polarity] != 0,
          (*this)[GlobalParameter::step_pulse_length]};
}

}  // namespace opentmcl
