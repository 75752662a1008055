#include "lang/disassembler.hpp"

#include <cstdint>
#include <string_view>
#include <utility>

#include "firmware/spec/instructions.hpp"
#include "lang/formatter.hpp"
#include "lang/hexadecimal.hpp"
#include "lang/instruction_table.hpp"
#include "lang/operand_field.hpp"
#include "lang/operand_meaning.hpp"

namespace opentmcl::lang {
namespace {

std::string label_name(std::size_t address) {
  return "L_" + std::to_string(address);
}

bool is_instruction(const InstructionSpec* row) {
  return row != nullptr && row->mnemonic != nullptr;
}

/// `command` with only the fields its operands fill.
Command without_unused_fields(const InstructionSpec& instruction, const Command& command) {
  Command used{command.opcode, 0, 0, 0};
  for (const OperandSpec& operand : instruction.operands) {
    switch (operand.field) {
      case Field::type:
        used.type = command.type;
        break;
      case Field::motor:
        used.motor = command.motor;
        break;
      case Field::value:
        used.value = command.value;
        break;
      case Field::none:
        break;
    }
  }
  return used;
}

/// Mnemonic form; addresses for which `is_label` holds are written as labels.
template <typename IsLabel>
DisassembledInstruction write_instruction(const Command& command, const ModuleDescription& module, IsLabel is_label) {
  const InstructionSpec* const instruction = find_instruction(command.opcode, module.id);
  if (!is_instruction(instruction)) {
    return {std::nullopt, "the " + describe(module) + " has no mnemonic for opcode " + std::to_string(command.opcode)};
  }
  if (without_unused_fields(*instruction, command) != command) {
    return {std::nullopt, std::string("a field that ") + instruction->mnemonic + " does not use is not 0"};
  }
  std::string text = instruction->mnemonic;
  for (std::size_t i = 0; i < operand_count(*instruction); ++i) {
    const OperandSpec& operand = instruction->operands[i];
    const std::int32_t value = operand_value(command, operand);
    text += i == 0 ? " " : ", ";
    if (takes_words(operand.kind)) {
      const char* const word = word_of(operand.kind, value);
      if (word == nullptr) {
        return {std::nullopt,
                std::to_string(value) + " is no operand " + std::to_string(i + 1) + " of " + instruction->mnemonic};
      }
      text += word;
    } else if (operand.kind == OperandKind::address && is_label(value)) {
      text += label_name(static_cast<std::size_t>(value));
    } else {
      text += std::to_string(value);
    }
  }
  return {std::move(text), {}};
}

/// For each address up to the one behind the last instruction: whether an instruction names it.
std::vector<bool> find_targets(const std::vector<Command>& commands, const ModuleDescription& module) {
  std::vector<bool> targets(commands.size() + 1);
  for (const Command& command : commands) {
    const InstructionSpec* const instruction = find_instruction(command.opcode, module.id);
    if (!is_instruction(instruction)) continue;
    for (const OperandSpec& operand : instruction->operands) {
      if (operand.kind != OperandKind::address) continue;
      const std::int32_t target = operand_value(command, operand);
      if (target >= 0 && static_cast<std::size_t>(target) < targets.size()) {
        targets[static_cast<std::size_t>(target)] = true;
      }
    }
  }
  return targets;
}

}  // namespace

DisassembledInstruction disassemble_instruction(const Command& command, const ModuleDescription& module) {
  return write_instruction(command, module, [](std::int32_t) { return false; });
}

std::string instruction_comment(const Command& command, const ModuleDescription& module,
                                const units::PhysicalScale& scale) {
  const InstructionSpec* const instruction = find_instruction(command.opcode, module.id);
  if (!is_instruction(instruction)) return {};
  std::string comment;
  for (const OperandSpec& operand : instruction->operands) {
    const std::string_view name = name_of_operand(operand, command, module);
    const std::string value =
        units::short_physical_value(unit_of_operand(operand, command, module), operand_value(command, operand), scale);
    if (!comment.empty() && !value.empty()) comment += " = ";
    comment += name;
    comment += value;
  }
  return comment;
}

Disassembly disassemble(const std::vector<Command>& commands, const ModuleDescription& module, Comments comments) {
  const std::vector<bool> targets = find_targets(commands, module);
  const auto is_label = [&](std::int32_t address) {
    return address >= 0 && static_cast<std::size_t>(address) < targets.size();
  };
  Disassembly disassembly;
  disassembly.text = "// " + std::to_string(commands.size()) + " instructions for the " + describe(module) +
                     "\n// module: " + module.argument + "\n";
  const auto add_label = [&](std::size_t address) {
    if (targets[address]) disassembly.text += label_name(address) + ":\n";
  };
  units::PhysicalScale scale = units::factory_scale(module);
  for (std::size_t address = 0; address < commands.size(); ++address) {
    add_label(address);
    units::follow(commands[address], module, scale);
    DisassembledInstruction instruction = write_instruction(commands[address], module, is_label);
    if (instruction.text) {
      const std::string comment =
          comments == Comments::meanings ? instruction_comment(commands[address], module, scale) : std::string();
      disassembly.text += "    " + *instruction.text + (comment.empty() ? "" : " // " + comment) + "\n";
    } else {
      disassembly.text += "    // " + hexadecimal(commands[address]) + ": " + instruction.reason + "\n";
      disassembly.problems.push_back({address, commands[address], std::move(instruction.reason)});
    }
  }
  add_label(commands.size());
  disassembly.text = format_source(disassembly.text);
  return disassembly;
}

}  // namespace opentmcl::lang
