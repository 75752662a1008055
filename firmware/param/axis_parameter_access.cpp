#include "firmware/param/axis_parameter_access.hpp"

namespace opentmcl {

namespace {

/// Parameter 193: a mode, and one option that belongs to it (PD-1161 manual 7.1): 64 with modes 1 to 4, which the
/// TMCM-1110 does not have, 128 with 5 to 8.
constexpr bool is_reference_search_mode(ModuleId module, std::int32_t value) {
  constexpr std::int32_t search_right_switch = 64;
  constexpr std::int32_t invert_home_switch = 128;
  if (value >= 1 && value <= 8) return true;
  if (value >= search_right_switch + 1 && value <= search_right_switch + 4) return module == ModuleId::pd1161;
  return value >= invert_home_switch + 5 && value <= invert_home_switch + 8;
}

}  // namespace

std::uint8_t AxisParameterAccess::row_if(std::uint8_t number, Access access) const {
  const std::uint8_t row = axis_parameter_rows[number];
  return row != no_row && allows(columns_[row].access, access) ? row : no_row;
}

Status AxisParameterAccess::get(std::uint8_t number, std::int32_t& value) {
  const std::uint8_t row = row_if(number, Access::r);
  if (row == no_row) return Status::wrong_type;
  switch (static_cast<AxisParameter>(number)) {
    case AxisParameter::target_position:
      value = axis_.target_position();
      break;
    case AxisParameter::actual_position:
      value = axis_.position();
      break;
    case AxisParameter::target_speed:
      value = axis_.target_velocity();
      break;
    case AxisParameter::actual_speed:
      value = axis_.actual_velocity();
      break;
    case AxisParameter::actual_acceleration:
      value = axis_.actual_acceleration();
      break;
    case AxisParameter::position_reached:
      value = axis_.position_reached() ? 1 : 0;
      break;
    case AxisParameter::home_switch_state:
      value = is_high(pins_.inputs(), hal::InputPin::home_switch) ? 1 : 0;
      break;
    case AxisParameter::right_limit_switch_state:
      value = axis_.right_switch_active() ? 1 : 0;
      break;
    case AxisParameter::left_limit_switch_state:
      value = axis_.left_switch_active() ? 1 : 0;
      break;
    case AxisParameter::smart_energy_actual_current:
      value = axis_.actual_current_scale();
      break;
    case AxisParameter::actual_load_value:
      value = axis_.load_value();
      break;
    case AxisParameter::driver_error_flags:
      value = axis_.driver_flags();
      break;
    case AxisParameter::extended_error_flags:
      value = axis_.take_error_flags();
      break;
    case AxisParameter::encoder_position:
      value = axis_.encoder().position();
      break;
    case AxisParameter::absolute_encoder_value:
      value = axis_.encoder().absolute_angle();
      break;
    default:
      value = axis_.settings().in_row(row);
      break;
  }
  return Status::ok;
}

void AxisParameterAccess::apply(AxisParameter parameter, std::size_t row, std::int32_t value) {
  switch (parameter) {
    case AxisParameter::target_position:
      axis_.set_target_position(value);
      break;
    case AxisParameter::actual_position:
      axis_.set_position(value);
      break;
    case AxisParameter::target_speed:
      axis_.set_target_velocity(value);
      break;
    case AxisParameter::encoder_position:
      axis_.encoder().set_position(value);
      break;
    default:
      axis_.settings().set_row(row, value);
      axis_.apply(parameter);
      break;
  }
}

Status AxisParameterAccess::set(std::uint8_t number, std::int32_t value) {
  const std::uint8_t row = row_if(number, Access::w);
  if (row == no_row) return Status::wrong_type;
  if (value < columns_[row].minimum || value > columns_[row].maximum) return Status::invalid_value;
  const auto parameter = static_cast<AxisParameter>(number);
  if (parameter == AxisParameter::reference_search_mode && !is_reference_search_mode(module_, value)) {
    return Status::invalid_value;
  }
  apply(parameter, row, value);
  return Status::ok;
}

Status AxisParameterAccess::store(std::uint8_t number, bool is_locked) {
  const std::uint8_t row = row_if(number, Access::e);
  if (row == no_row) return Status::wrong_type;
  if (is_locked) return Status::eeprom_locked;
  store_.store(eeprom_layout::axis_parameter_slot[row], axis_.settings().in_row(row));
  return Status::ok;
}

Status AxisParameterAccess::restore(std::uint8_t number) {
  const std::uint8_t row = row_if(number, Access::e);
  if (row == no_row) return Status::wrong_type;
  const std::uint8_t slot = eeprom_layout::axis_parameter_slot[row];
  apply(static_cast<AxisParameter>(number), row, store_.holds(slot) ? store_.value(slot) : columns_[row].default_value);
  return Status::ok;
}

void AxisParameterAccess::load_stored() {
  for (std::size_t row = 0; row < axis_parameter_count; ++row) {
    const std::uint8_t slot = eeprom_layout::axis_parameter_slot[row];
    if (slot == no_row || !allows(columns_[row].access, Access::e) || !store_.holds(slot)) continue;
    const std::int32_t value = store_.value(slot);
    // A record with a right checksum and a value out of range would come from another firmware: better the default.
    if (value >= columns_[row].minimum && value <= columns_[row].maximum) axis_.settings().set_row(row, value);
  }
}

}  // namespace opentmcl
