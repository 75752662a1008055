// What the kinds of operands are called.
#pragma once

#include <cstddef>

#include "firmware/spec/instructions.hpp"

namespace opentmcl::lang {

struct OperandKindNames {
  OperandKind kind;
  const char* identifier;  ///< for programs, never the same for two kinds: "motor_or_all"
  const char* words;       ///< for readers: "motor"
};

/// In the order of the enumeration.
inline constexpr OperandKindNames operand_kind_names[] = {
    {OperandKind::none, "none", ""},
    {OperandKind::motor, "motor", "motor"},
    {OperandKind::motor_group, "motor_group", "motor"},
    {OperandKind::motor_or_all, "motor_or_all", "motor"},
    {OperandKind::bank, "bank", "bank"},
    {OperandKind::io_bank, "io_bank", "bank"},
    {OperandKind::axis_parameter, "axis_parameter", "axis parameter"},
    {OperandKind::global_parameter, "global_parameter", "global parameter"},
    {OperandKind::port, "port", "port"},
    {OperandKind::coordinate, "coordinate", "coordinate"},
    {OperandKind::velocity, "velocity", "velocity"},
    {OperandKind::position, "position", "position"},
    {OperandKind::value, "value", "value"},
    {OperandKind::ticks, "ticks", "ticks"},
    {OperandKind::address, "address", "label"},
    {OperandKind::interrupt, "interrupt", "interrupt"},
    {OperandKind::variable, "variable", "user variable"},
    {OperandKind::number, "number", "number"},
    {OperandKind::mvp_mode, "mvp_mode", "mode"},
    {OperandKind::rfs_action, "rfs_action", "action"},
    {OperandKind::calc_operation, "calc_operation", "operation"},
    {OperandKind::calcx_operation, "calcx_operation", "operation"},
    {OperandKind::variable_operation, "variable_operation", "operation"},
    {OperandKind::variable_value_operation, "variable_value_operation", "operation"},
    {OperandKind::condition, "condition", "condition"},
    {OperandKind::wait_event, "wait_event", "event"},
    {OperandKind::error_flag, "error_flag", "error flag"},
};

constexpr const OperandKindNames& names_of(OperandKind kind) {
  return operand_kind_names[static_cast<std::size_t>(kind)];
}

consteval bool operand_kinds_are_in_order() {
  std::size_t place = 0;
  for (const OperandKindNames& names : operand_kind_names) {
    if (static_cast<std::size_t>(names.kind) != place++) return false;
  }
  return names_of(OperandKind::error_flag).kind == OperandKind::error_flag;
}
static_assert(operand_kinds_are_in_order(), "a row for each kind, at its place");

}  // namespace opentmcl::lang
