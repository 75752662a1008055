#include "apps/tmcl/spec_words.hpp"

namespace opentmcl::app {

std::string letters_of(Access access) {
  std::string letters;
  if (allows(access, Access::r)) letters += 'R';
  if (allows(access, Access::w)) letters += 'W';
  if (allows(access, Access::e)) letters += 'E';
  if (allows(access, Access::a)) letters += 'A';
  return letters;
}

const char* name_of(OperandKind kind) {
  switch (kind) {
    case OperandKind::none:
      return "none";
    case OperandKind::motor:
      return "motor";
    case OperandKind::motor_group:
      return "motor_group";
    case OperandKind::motor_or_all:
      return "motor_or_all";
    case OperandKind::bank:
      return "bank";
    case OperandKind::io_bank:
      return "io_bank";
    case OperandKind::axis_parameter:
      return "axis_parameter";
    case OperandKind::global_parameter:
      return "global_parameter";
    case OperandKind::port:
      return "port";
    case OperandKind::coordinate:
      return "coordinate";
    case OperandKind::velocity:
      return "velocity";
    case OperandKind::position:
      return "position";
    case OperandKind::value:
      return "value";
    case OperandKind::ticks:
      return "ticks";
    case OperandKind::address:
      return "address";
    case OperandKind::interrupt:
      return "interrupt";
    case OperandKind::variable:
      return "variable";
    case OperandKind::number:
      return "number";
    case OperandKind::mvp_mode:
      return "mvp_mode";
    case OperandKind::rfs_action:
      return "rfs_action";
    case OperandKind::calc_operation:
      return "calc_operation";
    case OperandKind::calcx_operation:
      return "calcx_operation";
    case OperandKind::variable_operation:
      return "variable_operation";
    case OperandKind::variable_value_operation:
      return "variable_value_operation";
    case OperandKind::condition:
      return "condition";
    case OperandKind::wait_event:
      return "wait_event";
    case OperandKind::error_flag:
      return "error_flag";
  }
  return "unknown";
}

const char* name_of(Field field) {
  switch (field) {
    case Field::none:
      return "none";
    case Field::type:
      return "type";
    case Field::motor:
      return "motor";
    case Field::value:
      return "value";
  }
  return "unknown";
}

const char* name_of(Where where) {
  switch (where) {
    case Where::direct_and_program:
      return "direct and program";
    case Where::program_only:
      return "program";
    case Where::direct_only:
      return "direct";
  }
  return "unknown";
}

const char* name_of(InterruptSetting setting) {
  switch (setting) {
    case InterruptSetting::none:
      return "none";
    case InterruptSetting::period:
      return "period";
    case InterruptSetting::edge:
      return "edge";
  }
  return "unknown";
}

}  // namespace opentmcl::app
