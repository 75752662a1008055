// Programs and sources nobody has thought of: all instructions with all operands a source can express, and for each
// program one of the many sources that mean it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/include_files.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"
#include "lang/operand_field.hpp"

namespace opentmcl::lang {

/// Choices that a seed determines, on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t bits() { return engine_(); }
  /// 0…count - 1. @pre count > 0
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }

  template <typename Choices>
  const auto& one_of(const Choices& choices) {
    return choices[below(std::size(choices))];
  }

 private:
  std::mt19937_64 engine_;
};

inline std::vector<const InstructionSpec*> instructions_of(const ModuleDescription& module) {
  std::vector<const InstructionSpec*> rows;
  for (const InstructionSpec& row : instructions) {
    if (row.mnemonic != nullptr && contains(row.modules, module.id)) rows.push_back(&row);
  }
  return rows;
}

/// Small numbers, the ends of the range, powers of two, and any.
inline std::int32_t generated_value(Dice& dice) {
  const auto any = static_cast<std::int32_t>(static_cast<std::uint32_t>(dice.bits()));
  switch (dice.below(4)) {
    case 0:
      return any % 100;
    case 1:
      return any % 100000;
    case 2:
      return static_cast<std::int32_t>((std::uint32_t{1} << dice.below(32)) -
                                       static_cast<std::uint32_t>(dice.below(3)));
    default:
      return any;
  }
}

/// A number the assembler takes for an operand. @param program_size jumps go to places of the program, just behind it,
/// and seldom elsewhere
inline std::int32_t generated_operand(Dice& dice, const OperandSpec& operand, std::size_t program_size) {
  if (takes_words(operand.kind)) {
    const KeywordSet set = keywords_of(operand.kind);
    const Keyword& keyword = set.words[dice.below(set.count)];
    return keyword.value == set.excluded ? set.words[0].value : keyword.value;
  }
  if (operand.kind == OperandKind::address && !dice.one_in(16)) {
    return static_cast<std::int32_t>(dice.below(program_size + 1));
  }
  return operand.field == Field::value ? generated_value(dice) : static_cast<std::int32_t>(dice.below(256));
}

inline Command generated_command(Dice& dice, const InstructionSpec& row, std::size_t program_size) {
  Command command{static_cast<std::uint8_t>(row.opcode), 0, 0, 0};
  for (const OperandSpec& operand : row.operands) {
    const std::int32_t value = generated_operand(dice, operand, program_size);
    if (operand.field == Field::type) command.type = static_cast<std::uint8_t>(value);
    if (operand.field == Field::motor) command.motor = static_cast<std::uint8_t>(value);
    if (operand.field == Field::value) command.value = value;
  }
  return command;
}

inline std::vector<Command> generated_program(Dice& dice, const ModuleDescription& module, std::size_t size) {
  const std::vector<const InstructionSpec*> rows = instructions_of(module);
  std::vector<Command> commands;
  commands.reserve(size);
  while (commands.size() < size) commands.push_back(generated_command(dice, *dice.one_of(rows), size));
  return commands;
}

/// Writes a program as a source with blanks, comments, line ends, upper and lower case, labels, constants and
/// expressions as they fall.
class SourceGenerator {
 public:
  SourceGenerator(Dice& dice, const ModuleDescription& module) : dice_(&dice), module_(&module) {}

  std::string source_of(const std::vector<Command>& commands) {
    line_end_ = dice_->one_of(line_ends);
    if (dice_->one_in(8)) text_ += "\xEF\xBB\xBF";
    has_parameter_names_ = dice_->one_in(4);
    if (has_parameter_names_) end_line(std::string("#include") + blanks(1) + parameter_file_name);
    name_targets(commands);
    for (std::size_t address = 0; address <= commands.size(); ++address) {
      add_label(address, address == commands.size());
      if (address < commands.size()) add_instruction(commands[address]);
    }
    const bool ends_line = !text_.empty() && (text_.back() == '\n' || text_.back() == '\r');
    if (ends_line && dice_->one_in(4)) text_.pop_back();  // perhaps the LF of CR LF
    return std::move(text_);
  }

 private:
  static constexpr std::string_view line_ends[] = {"\n", "\r\n", "\r"};
  static constexpr std::string_view comments[] = {
      "// a comment", "//", "; another", "// ° § ü", "// \xE9t\xE9", "//==== , : = #include", "// trailing blanks \t "};

  std::string blanks(std::size_t minimum = 0) {
    std::string text;
    for (std::size_t count = minimum + dice_->below(3); count > 0; --count) text += dice_->one_in(4) ? '\t' : ' ';
    return text;
  }

  std::string any_case(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
      if (starts_name(c) && c != '_' && dice_->one_in(2)) c = static_cast<char>(c ^ 0x20);
    }
    return result;
  }

  void end_line(const std::string& line) {
    text_ += blanks() + line + blanks();
    if (dice_->one_in(4)) text_ += dice_->one_of(comments);
    text_ += line_end_;
    while (dice_->one_in(4)) text_ += blanks() + std::string(line_end_);
    if (dice_->one_in(8)) text_ += blanks() + std::string(dice_->one_of(comments)) + std::string(line_end_);
  }

  void name_targets(const std::vector<Command>& commands) {
    for (const Command& command : commands) {
      for (const OperandSpec& operand : find_instruction(command.opcode, module_->id)->operands) {
        if (operand.kind != OperandKind::address || command.value < 0) continue;
        const auto target = static_cast<std::size_t>(command.value);
        if (target <= commands.size()) labels_[target] = "Label_" + std::to_string(target);
      }
    }
  }

  /// On a line of its own, or later before the instruction.
  void add_label(std::size_t address, bool is_last) {
    if (const auto label = labels_.find(address); label != labels_.end())
      pending_label_ = any_case(label->second) + ":";
    if (pending_label_.empty() || (!is_last && dice_->one_in(2))) return;
    end_line(pending_label_);
    pending_label_.clear();
  }

  void add_instruction(const Command& command) {
    const InstructionSpec& instruction = *find_instruction(command.opcode, module_->id);
    std::string operands;
    const std::size_t count = operand_count(instruction);
    for (std::size_t i = 0; i < count; ++i) {
      operands += (i == 0 ? blanks(1) : blanks() + "," + blanks()) + operand_text(command, instruction.operands[i]);
    }
    const bool is_surplus_allowed = count > 0 && count < maximum_operands;
    if (is_surplus_allowed && dice_->one_in(8)) operands += blanks() + "," + blanks() + "0";
    const std::string label = pending_label_.empty() ? std::string() : pending_label_ + blanks();
    pending_label_.clear();
    end_line(label + any_case(instruction.mnemonic) + operands);
  }

  std::string operand_text(const Command& command, const OperandSpec& operand) {
    const std::int32_t value = operand_value(command, operand);
    if (takes_words(operand.kind) && !dice_->one_in(4)) return any_case(word_of(operand.kind, value));
    if (operand.kind == OperandKind::address && !dice_->one_in(4)) {
      const auto label = value < 0 ? labels_.end() : labels_.find(static_cast<std::size_t>(value));
      if (label != labels_.end()) return any_case(label->second);
    }
    if (operand.kind == OperandKind::axis_parameter && has_parameter_names_) {
      for (const AxisParameterSpec& row : axis_parameters) {
        const bool exists = row.in(module_->id).access != Access::none;
        if (exists && static_cast<int>(row.number) == value) return any_case(row.symbol);
      }
    }
    return expression(value, 0);
  }

  /// Some expression that is rounded to `value`.
  std::string expression(std::int32_t value, int depth) {
    switch (depth > 3 ? 0 : dice_->below(16)) {
      case 1:
        return pattern('$', value, 4);
      case 2:
        return pattern('%', value, 1);
      case 3: {
        const std::int32_t part = generated_value(*dice_) / 2;
        const std::int32_t rest = value / 2 - part / 2;
        return sum(rest, static_cast<std::int64_t>(value) - rest, depth);
      }
      case 4:
        return std::to_string(value) + ".25";
      case 5:
        return "(" + blanks() + expression(value, depth + 1) + blanks() + ")";
      case 6:
        return "-" + blanks() + "(" + std::to_string(-static_cast<std::int64_t>(value)) + ")";
      case 7:
        return any_case(dice_->one_in(2) ? "round" : "int") + blanks() + "(" + expression(value, 4) + ")";
      case 8:
        return expression(value, 4) + blanks() + "*" + blanks() + "3" + blanks() + "/" + blanks() + "3";
      case 9:
        return "2^3" + blanks() + "*" + blanks() + "(" + std::to_string(value) + blanks() + "/ 8.0)";
      case 10:
      case 11:
        return constant(value);
      default:
        return std::to_string(value);
    }
  }

  std::string sum(std::int32_t left, std::int64_t right, int depth) {
    const std::string sign = right < 0 && dice_->one_in(2) ? "-" : "+";
    const std::string term = std::to_string(sign == "-" ? -right : right);
    return expression(left, depth + 1) + blanks() + sign + blanks() + term;
  }

  static std::string pattern(char sign, std::int32_t value, unsigned bits_per_digit) {
    auto rest = static_cast<std::uint32_t>(value);
    std::string digits;
    do {
      digits.insert(digits.begin(), "0123456789aBCDeF"[rest & ((1U << bits_per_digit) - 1)]);
      rest >>= bits_per_digit;
    } while (rest != 0);
    return sign + digits;
  }

  /// A name for `value`, defined on a line of its own before the one that is being written.
  std::string constant(std::int32_t value) {
    const auto [constant, is_new] = constants_.try_emplace(value, "Constant_" + std::to_string(constants_.size()));
    if (is_new) {
      end_line(any_case(constant->second) + blanks() + "=" + blanks() + std::to_string(value));
    }
    return any_case(constant->second);
  }

  Dice* dice_;
  const ModuleDescription* module_;
  std::string text_;
  std::string_view line_end_;
  bool has_parameter_names_ = false;
  std::map<std::size_t, std::string> labels_;  // by address
  std::map<std::int32_t, std::string> constants_;
  std::string pending_label_;
};

inline std::string generated_source(Dice& dice, const ModuleDescription& module, const std::vector<Command>& commands) {
  return SourceGenerator(dice, module).source_of(commands);
}

}  // namespace opentmcl::lang
