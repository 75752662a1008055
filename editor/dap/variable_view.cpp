#include "editor/dap/variable_view.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "debug/assignment.hpp"
#include "debug/inner_state_text.hpp"
#include "editor/dap/memory.hpp"
#include "editor/dap/used_variables.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/io_ports.hpp"
#include "lang/assembler.hpp"
#include "lang/diagnostic.hpp"
#include "lang/operand_meaning.hpp"
#include "units/physical_value.hpp"

namespace opentmcl::editor::dap {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// What a variablesReference stands for. There is one thread and one set of everything, so the same number always
/// means the same.
enum Reference : std::int64_t {
  registers_reference = 1,
  user_variables_reference,
  all_variables_reference,
  axis_reference,
  global_reference,
  bench_reference,
  axis_parameter_reference = 0x100,    ///< and its number: one that is read alone
  global_parameter_reference = 0x200,  ///< likewise
  end_of_references = 0x300,
};

constexpr std::int64_t numbers_a_reference = 0x100;

/// Shown in place of what is not read together with the others.
constexpr const char* not_yet_read = "reading it changes it";

constexpr std::int64_t lazy_reference_of(AxisParameter parameter) {
  const bool is_forgotten = parameter == AxisParameter::extended_error_flags;  // erratum E-31
  return is_forgotten ? axis_parameter_reference + static_cast<std::int64_t>(parameter) : 0;
}

constexpr std::int64_t lazy_reference_of(GlobalParameter parameter) {
  const bool draws_a_number = parameter == GlobalParameter::random_number;
  return draws_a_number ? global_parameter_reference + static_cast<std::int64_t>(parameter) : 0;
}

std::string expression_of_variable(std::int64_t number) {
  return "VAR(" + std::to_string(number) + ")";
}
std::string expression_of(AxisParameter parameter) {
  return "GAP(" + std::to_string(static_cast<int>(parameter)) + ")";
}
std::string expression_of(GlobalParameter parameter) {
  return "GGP(" + std::to_string(static_cast<int>(parameter)) + ", " +
         std::to_string(static_cast<int>(Bank::module_settings)) + ")";
}

json entry(std::string_view name, std::string value) {
  return {{"name", name}, {"value", std::move(value)}, {"variablesReference", 0}};
}

json read_only(json variable) {
  variable["presentationHint"]["attributes"] = {"readOnly"};
  return variable;
}

json with_expression(json variable, std::string expression) {
  variable["evaluateName"] = std::move(expression);
  return variable;
}

template <class Table>
auto find_row(const Table& table, std::string_view name) {
  return std::find_if(std::begin(table), std::end(table), [&](const auto& row) { return row.name == name; });
}

/// A value as it is shown begins with the number: "1000 = 35.8 rpm", "5 (Loop+2)".
std::string without_explanation(const std::string& value) {
  return value.substr(0, std::min(value.find(" = "), value.find(" (")));
}

/// "GAP 4, 0" for "GAP(4)": the instruction that a read in an expression stands for; nothing if it is none.
std::string instruction_of(std::string_view expression) {
  const std::size_t open = expression.find('(');
  if (open == std::string_view::npos || !expression.ends_with(')')) return {};
  const std::string_view inside = expression.substr(open + 1, expression.size() - open - 2);
  if (inside.find_first_of("()") != std::string_view::npos) return {};
  const bool has_both = inside.find(',') != std::string_view::npos;
  return std::string(expression.substr(0, open)).append(" ").append(inside).append(has_both ? "" : ", 0");
}

/// What the answer to a command measures: what the instruction that sets the same measures.
Unit unit_of_read(Command command, const ModuleDescription& module) {
  constexpr OperandSpec written{OperandKind::value, Field::value, int32_minimum, int32_maximum};
  switch (static_cast<Opcode>(command.opcode)) {
    case Opcode::gap:
      command.opcode = static_cast<std::uint8_t>(Opcode::sap);
      return lang::unit_of_operand(written, command, module);
    case Opcode::ggp:
      command.opcode = static_cast<std::uint8_t>(Opcode::sgp);
      return lang::unit_of_operand(written, command, module);
    case Opcode::gio:
      for (const IoPortSpec& row : io_ports) {
        const bool is_it = row.port == command.type && static_cast<std::uint8_t>(row.bank) == command.motor;
        if (is_it && contains(row.modules, module.id)) return row.unit;
      }
      return Unit::none;
    default:
      return Unit::none;
  }
}

/// Whether an answer that is missing says something of one value only, and not of the whole connection.
bool is_about_one_value(const Error& error) {
  return error.kind == ErrorKind::refused || error.kind == ErrorKind::usage;
}

}  // namespace

json VariableView::scopes() const {
  const auto scope = [](const char* name, std::int64_t reference, bool is_expensive) {
    return json{{"name", name}, {"variablesReference", reference}, {"expensive", is_expensive}};
  };
  json registers = scope("Registers", registers_reference, false);
  registers["presentationHint"] = "registers";
  json scopes = json::array({std::move(registers), scope("Variables", user_variables_reference, false),
                             scope("Axis", axis_reference, true), scope("Global", global_reference, true)});
  if (engine_.target().twin() != nullptr) scopes.push_back(scope("Bench", bench_reference, true));
  return {{"scopes", std::move(scopes)}};
}

Answer VariableView::variables(const json& arguments) const {
  const Result<std::int64_t> reference = required_integer(arguments, "variablesReference");
  if (!reference) return reference.error();
  const Result<std::int64_t> start = optional_integer(arguments, "start", 0);
  if (!start) return start.error();
  const Result<std::int64_t> count = optional_integer(arguments, "count", 0);
  if (!count) return count.error();
  const auto of_reference = [&]() -> Result<json> {
    switch (*reference) {
      case registers_reference:
        return registers();
      case user_variables_reference:
        return user_variables();
      case all_variables_reference:
        return all_variables(*start, *count);
      case axis_reference:
        return axis();
      case global_reference:
        return global();
      case bench_reference:
        return bench();
      default:
        return read_at_last(*reference);
    }
  };
  Result<json> variables = of_reference();
  if (!variables) return variables;
  return json{{"variables", std::move(*variables)}};
}

// ---- What there is

Result<json> VariableView::registers() const {
  const Result<debug::RegisterValues> values = engine_.registers();
  if (!values) return values.error();
  const auto [a, x, counter, inner] = *values;
  json registers = json::array();
  registers.push_back(with_expression(entry("A", std::to_string(a)), "A"));
  registers.push_back(with_expression(entry("X", std::to_string(x)), "X"));
  json place = entry("PC", std::to_string(counter) + " (" + std::string(engine_.program().name_of(counter)) + ")");
  place["memoryReference"] = memory_reference(counter);
  registers.push_back(read_only(with_expression(std::move(place), "PC")));
  const std::string depth = std::to_string(engine_.frames().size() - 1);
  registers.push_back(
      read_only(entry("stack depth", engine_.frames_are_whole() ? depth : depth + " or more: not all of it was seen")));
  if (!inner) return registers;
  registers.push_back(read_only(entry("comparison", debug::name_of(inner->comparison))));
  registers.push_back(read_only(entry("error flags", debug::names_of_error_flags(inner->error_flags))));
  registers.push_back(read_only(entry("interrupts", debug::names_of_interrupts(inner->enabled_interrupts))));
  return registers;
}

Result<json> VariableView::user_variables() const {
  json variables = json::array();
  for (const std::uint8_t number : used_variables(engine_.program().commands(), engine_.program().module().id)) {
    const Result<std::int32_t> value = engine_.variable(number);
    if (!value) return value.error();
    const std::string expression = expression_of_variable(number);
    variables.push_back(with_expression(entry(expression, std::to_string(*value)), expression));
  }
  json all = entry("all", std::to_string(user_variable_count) + " variables");
  all["variablesReference"] = all_variables_reference;
  all["indexedVariables"] = user_variable_count;
  variables.push_back(read_only(std::move(all)));
  return variables;
}

Result<json> VariableView::all_variables(std::int64_t start, std::int64_t count) const {
  constexpr auto end_of_all = static_cast<std::int64_t>(user_variable_count);
  const std::int64_t begin = std::clamp<std::int64_t>(start, 0, end_of_all);
  const std::int64_t end = count > 0 && count < end_of_all - begin ? begin + count : end_of_all;
  json variables = json::array();
  for (std::int64_t number = begin; number < end; ++number) {
    const Result<std::int32_t> value = engine_.variable(static_cast<std::uint8_t>(number));
    if (!value) return value.error();
    const std::string expression = expression_of_variable(number);
    variables.push_back(with_expression(entry(expression, std::to_string(*value)), expression));
  }
  return variables;
}

template <class Row>
Result<json> VariableView::parameter(const Row& row, std::string expression, std::int64_t lazy_reference) const {
  json variable;
  if (lazy_reference != 0) {
    variable = entry(row.name, not_yet_read);
    variable["variablesReference"] = lazy_reference;
    variable["presentationHint"]["lazy"] = true;
  } else {
    const Result<double> number = engine_.evaluate(expression);
    if (!number && !is_about_one_value(number.error())) return number.error();
    if (number.ok()) {
      const Result<std::string> value = with_physical_value(row.unit, static_cast<std::int32_t>(*number));
      if (!value) return value.error();
      variable = entry(row.name, *value);
    } else {
      variable = entry(row.name, number.error().message);
    }
  }
  variable["type"] = row.description;
  if (!allows(row.in(engine_.program().module().id).access, Access::w)) variable = read_only(std::move(variable));
  return with_expression(std::move(variable), std::move(expression));
}

Result<json> VariableView::axis() const {
  json variables = json::array();
  for (const AxisParameterSpec& row : axis_parameters) {
    if (!allows(row.in(engine_.program().module().id).access, Access::r)) continue;
    Result<json> variable = parameter(row, dap::expression_of(row.number), lazy_reference_of(row.number));
    if (!variable) return variable;
    variables.push_back(std::move(*variable));
  }
  return variables;
}

Result<json> VariableView::global() const {
  json variables = json::array();
  for (const GlobalParameterSpec& row : global_parameters) {
    if (!allows(row.in(engine_.program().module().id).access, Access::r)) continue;
    Result<json> variable = parameter(row, dap::expression_of(row.number), lazy_reference_of(row.number));
    if (!variable) return variable;
    variables.push_back(std::move(*variable));
  }
  return variables;
}

Result<json> VariableView::bench() const {
  debug::TwinPowers* const twin = engine_.target().twin();
  if (twin == nullptr) return mistake("a module does not know its bench; a twin does");
  json variables = json::array();
  for (const std::string_view name : twin->quantity_names()) {
    const Result<std::string> value = value_of(std::string(name));
    if (!value) return value.error();
    variables.push_back(with_expression(entry(name, *value), std::string(name)));
  }
  return variables;
}

Result<json> VariableView::read_at_last(std::int64_t reference) const {
  if (reference < axis_parameter_reference || reference >= end_of_references) {
    return mistake("there is no variablesReference " + std::to_string(reference));
  }
  const auto number = static_cast<std::uint8_t>(reference % numbers_a_reference);
  const std::string expression = reference < global_parameter_reference
                                     ? dap::expression_of(static_cast<AxisParameter>(number))
                                     : dap::expression_of(static_cast<GlobalParameter>(number));
  const Result<std::string> value = value_of(expression);
  if (!value) return value.error();
  return json::array({read_only(entry("value", *value))});
}

// ---- Single values

Result<std::string> VariableView::expression_of(std::int64_t reference, const std::string& name) const {
  switch (reference) {
    case registers_reference:
    case user_variables_reference:
    case all_variables_reference:
    case bench_reference:
      return name;
    case axis_reference:
      if (const auto row = find_row(axis_parameters, name); row != std::end(axis_parameters)) {
        return dap::expression_of(row->number);
      }
      break;
    case global_reference:
      if (const auto row = find_row(global_parameters, name); row != std::end(global_parameters)) {
        return dap::expression_of(row->number);
      }
      break;
    default:
      break;
  }
  return mistake("there is no variable " + lang::in_quotes(name));
}

Result<std::string> VariableView::with_physical_value(Unit unit, std::int32_t value) const {
  if (unit == Unit::none) return std::to_string(value);
  units::PhysicalScale scale = units::factory_scale(engine_.program().module());
  const std::pair<AxisParameter, std::int32_t*> parts[] = {
      {AxisParameter::pulse_divisor, &scale.pulse_divisor},
      {AxisParameter::ramp_divisor, &scale.ramp_divisor},
      {AxisParameter::microstep_resolution, &scale.microstep_resolution}};
  for (const auto& [parameter, part] : parts) {
    const Result<std::int32_t> read = engine_.target().client().axis_parameter(parameter);
    if (!read) return read.error();
    *part = *read;
  }
  return units::number_with_physical_value(unit, value, scale);
}

Result<std::string> VariableView::value_of(const std::string& text) const {
  const Result<double> value = engine_.evaluate(text);
  if (!value) {
    debug::TwinPowers* const twin = engine_.target().twin();
    if (twin == nullptr || value.error().kind != ErrorKind::usage) return value.error();
    const std::vector<std::string_view> names = twin->quantity_names();
    if (std::find(names.begin(), names.end(), text) == names.end()) return value.error();
    const Result<std::string> quantity = twin->quantity(text);
    if (!quantity) return quantity.error();
    const std::string beginning = text + " is ";
    return quantity->starts_with(beginning) ? quantity->substr(beginning.size()) : *quantity;
  }
  const std::string instruction = debug::Engine::is_instruction(text) ? text : instruction_of(text);
  const lang::InstructionResult read = lang::parse_instruction(instruction, engine_.program().module());
  const bool is_whole = *value == std::trunc(*value) && std::abs(*value) <= int32_maximum;
  if (!read.command || !is_whole) return debug::value_text(*value);
  const Unit unit = unit_of_read(*read.command, engine_.program().module());
  return with_physical_value(unit, static_cast<std::int32_t>(*value));
}

Result<std::string> VariableView::assign(const std::string& expression, const std::string& value) const {
  const Result<double> number = engine_.evaluate(without_explanation(value));
  if (!number) return number.error();
  if (const Result<void> assigned = debug::assign(engine_, expression, *number); !assigned) return assigned.error();
  return value_of(expression);
}

}  // namespace opentmcl::editor::dap
