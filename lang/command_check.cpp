#include "lang/command_check.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/interrupts.hpp"
#include "lang/instruction_table.hpp"
#include "lang/operand_field.hpp"
#include "lang/operand_meaning.hpp"
#include "lang/table_rows.hpp"

namespace opentmcl::lang {
namespace {

constexpr int move_to_coordinate = value_of_word(OperandKind::mvp_mode, "COORD");
constexpr int wait_for_ticks = value_of_word(OperandKind::wait_event, "TICKS");
static_assert(move_to_coordinate >= 0 && wait_for_ticks >= 0);

/// What an instruction does to the parameter it names.
Access wanted_access(Opcode opcode) {
  switch (opcode) {
    case Opcode::sap:
    case Opcode::aap:
    case Opcode::sgp:
    case Opcode::agp:
      return Access::w;
    case Opcode::gap:
    case Opcode::ggp:
      return Access::r;
    case Opcode::stap:
    case Opcode::rsap:
      return Access::e;
    default:
      return Access::none;
  }
}

/// What a user who comes from modules that take physical units has to know.
const char* note_on(Unit unit) {
  switch (unit) {
    case Unit::internal_velocity:
      return "speeds are internal units of these modules, not steps per second";
    case Unit::internal_acceleration:
      return "accelerations are internal units of these modules, not steps per second squared";
    default:
      return "";
  }
}

class CommandCheck {
 public:
  CommandCheck(const InstructionSpec& instruction, const Command& command, const ModuleDescription& module,
               const Statement& statement, const Scope& scope, DiagnosticList& diagnostics)
      : instruction_(&instruction),
        command_(&command),
        module_(&module),
        statement_(&statement),
        scope_(&scope),
        diagnostics_(&diagnostics) {}

  void run() {
    const std::size_t count = std::min(operand_count(*instruction_), statement_->operands.size());
    for (std::size_t i = 0; i < count; ++i) check_operand(i);
  }

 private:
  void check_operand(std::size_t index) {
    const OperandSpec& operand = instruction_->operands[index];
    const std::int32_t value = operand_value(*command_, operand);
    if (value < operand.minimum || value > operand.maximum) return report_range(index, value);
    switch (operand.kind) {
      case OperandKind::motor:
        if (instruction_->opcode != Opcode::wait || command_->type != wait_for_ticks) check_motor(index);
        break;
      case OperandKind::motor_group:
        if (command_->type != move_to_coordinate) check_motor(index);
        break;
      case OperandKind::motor_or_all:
        if (value != all_motors) check_motor(index);
        break;
      case OperandKind::axis_parameter:
        check_axis_parameter(index);
        break;
      case OperandKind::global_parameter:
        check_global_parameter(index);
        break;
      case OperandKind::interrupt:
        check_interrupt(index);
        break;
      default:
        break;
    }
  }

  Span span_of(std::size_t index) const { return scope_->span_of(statement_->operands[index]); }

  [[gnu::cold]] void report_range(std::size_t index, std::int32_t value) {
    const OperandSpec& operand = instruction_->operands[index];
    diagnostics_->add(DiagnosticKind::operand_out_of_range, span_of(index),
                      std::to_string(value) + " is outside " + range_text(operand.minimum, operand.maximum) +
                          ", the range of this operand of " + instruction_->mnemonic,
                      operand.kind == OperandKind::velocity ? note_on(Unit::internal_velocity) : "");
  }

  void check_motor(std::size_t index) {
    if (command_->motor >= module_->axis_count) report_motor(index);
  }

  [[gnu::cold]] void report_motor(std::size_t index) {
    diagnostics_->add(DiagnosticKind::no_such_motor, span_of(index),
                      "the " + describe(*module_) + " has no motor " + std::to_string(command_->motor));
  }

  void check_axis_parameter(std::size_t index) {
    const AxisParameterSpec* const parameter = find_axis_parameter(command_->type, *module_);
    if (parameter == nullptr) return missing(index, "axis parameter " + std::to_string(command_->type));
    check_parameter(index, *parameter, "axis parameter");
  }

  void check_global_parameter(std::size_t index) {
    switch (static_cast<Bank>(command_->motor)) {
      case Bank::module_settings:
        return check_module_setting(index);
      case Bank::interrupt_settings:
        return check_interrupt_setting(index);
      case Bank::customer:
      case Bank::user_variables:
        return;
    }
    missing(index, "bank " + std::to_string(command_->motor) + " of global parameters");
  }

  void check_module_setting(std::size_t index) {
    const GlobalParameterSpec* const setting = find_module_setting(command_->type, *module_);
    if (setting == nullptr) {
      return missing(index, "global parameter " + std::to_string(command_->type) + " in bank 0");
    }
    check_parameter(index, *setting, "global parameter");
  }

  void check_interrupt_setting(std::size_t index) {
    const InterruptSpec* const interrupt = find_interrupt(command_->type, *module_);
    const bool exists = interrupt != nullptr && interrupt->setting != InterruptSetting::none;
    if (!exists) missing(index, "global parameter " + std::to_string(command_->type) + " in bank 3");
  }

  void check_interrupt(std::size_t index) {
    if (find_interrupt(command_->type, *module_) != nullptr) return;
    missing(index, "interrupt " + std::to_string(command_->type));
  }

  [[gnu::cold]] void missing(std::size_t index, const std::string& what) {
    diagnostics_->add(DiagnosticKind::no_such_parameter, span_of(index),
                      "the " + describe(*module_) + " has no " + what);
  }

  template <typename Row>
  void check_parameter(std::size_t index, const Row& row, const char* what) {
    const ParameterColumn& column = row.in(module_->id);
    const Access wanted = wanted_access(instruction_->opcode);
    const auto described = [&] {
      return std::string(what) + " " + std::to_string(command_->type) + " (" + row.name + ")";
    };
    if (wanted != Access::none && !allows(column.access, wanted)) {
      const char* const reason = wanted == Access::w   ? " can only be read"
                                 : wanted == Access::r ? " can only be written"
                                                       : " cannot be stored in the EEPROM of this module";
      diagnostics_->add(DiagnosticKind::parameter_not_accessible, span_of(index), described() + reason);
      return;
    }
    const bool sets_value = instruction_->opcode == Opcode::sap || instruction_->opcode == Opcode::sgp;
    if (!sets_value || (command_->value >= column.minimum && command_->value <= column.maximum)) return;
    diagnostics_->add(DiagnosticKind::parameter_out_of_range, span_of(operand_count(*instruction_) - 1),
                      std::to_string(command_->value) + " is outside " + range_text(column.minimum, column.maximum) +
                          ", the range of " + described(),
                      note_on(row.unit));
  }

  const InstructionSpec* instruction_;
  const Command* command_;
  const ModuleDescription* module_;
  const Statement* statement_;
  const Scope* scope_;
  DiagnosticList* diagnostics_;
};

}  // namespace

void check_command(const InstructionSpec& instruction, const Command& command, const ModuleDescription& module,
                   const Statement& statement, const Scope& scope, DiagnosticList& diagnostics) {
  CommandCheck(instruction, command, module, statement, scope, diagnostics).run();
}

}  // namespace opentmcl::lang
