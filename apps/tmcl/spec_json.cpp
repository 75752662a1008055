#include "apps/tmcl/spec_json.hpp"

#include <nlohmann/json.hpp>

#include "apps/tmcl/spec_words.hpp"
#include "lang/expression.hpp"
#include "lang/operand_kind.hpp"

namespace opentmcl::app {

using Json = nlohmann::ordered_json;

namespace {

Json json_of(Modules set) {
  Json names = Json::array();
  for (const ModuleDescription& module : modules) {
    if (contains(set, module.id)) names.push_back(module.argument);
  }
  return names;
}

Json json_of(const ModuleDescription& module) {
  return {{"name", module.name},
          {"argument", module.argument},
          {"type_number", module.type_number},
          {"firmware_major", module.firmware_major},
          {"firmware_minor", module.firmware_minor},
          {"axis_count", module.axis_count},
          {"program_capacity", module.program_capacity},
          {"full_scale_current", module.full_scale_current}};
}

Json json_of(const OperandSpec& operand) {
  Json words = Json::array();
  const KeywordSet keywords = keywords_of(operand.kind);
  for (std::size_t i = 0; i < keywords.count; ++i) {
    const Keyword& keyword = keywords.words[i];
    if (keyword.value == keywords.excluded) continue;
    words.push_back({{"word", keyword.word}, {"value", keyword.value}, {"description", keyword.description}});
  }
  Json json{{"kind", lang::names_of(operand.kind).identifier},
            {"field", name_of(operand.field)},
            {"minimum", operand.minimum},
            {"maximum", operand.maximum}};
  if (!words.empty()) json["words"] = words;
  return json;
}

Json json_of(const InstructionSpec& instruction) {
  Json operands = Json::array();
  for (const OperandSpec& operand : instruction.operands) {
    if (operand.kind != OperandKind::none) operands.push_back(json_of(operand));
  }
  return {{"opcode", static_cast<unsigned>(instruction.opcode)},
          {"mnemonic", instruction.mnemonic == nullptr ? Json() : Json(instruction.mnemonic)},
          {"where", name_of(instruction.where)},
          {"reads", instruction.reads},
          {"ascii", instruction.ascii},
          {"modules", json_of(instruction.modules)},
          {"operands", operands},
          {"description", instruction.description},
          {"source", instruction.source}};
}

/// Axis and global parameters have the same columns.
template <class Row>
Json json_of_parameter(const Row& row) {
  Json columns = Json::object();
  for (const ModuleDescription& module : modules) {
    const ParameterColumn& column = row.in(module.id);
    if (column.access == Access::none) continue;
    columns[module.argument] = {{"access", letters_of(column.access)},
                                {"minimum", column.minimum},
                                {"maximum", column.maximum},
                                {"default", column.default_value}};
  }
  return {{"number", static_cast<unsigned>(row.number)},
          {"symbol", row.symbol},
          {"name", row.name},
          {"unit", name_of(row.unit)},
          {"modules", columns},
          {"description", row.description},
          {"source", row.source}};
}

Json json_of(const InterruptSpec& interrupt) {
  return {{"number", static_cast<unsigned>(interrupt.number)},
          {"symbol", interrupt.symbol},
          {"name", interrupt.name},
          {"setting", name_of(interrupt.setting)},
          {"modules", json_of(interrupt.modules)}};
}

Json json_of(const StatusSpec& status) {
  return {{"code", static_cast<unsigned>(status.code)},
          {"name", status.name},
          {"description", status.description},
          {"source", status.source}};
}

Json json_of(const IoPortSpec& port) {
  return {{"bank", static_cast<unsigned>(port.bank)},
          {"port", port.port},
          {"symbol", port.symbol},
          {"access", letters_of(port.access)},
          {"minimum", port.minimum},
          {"maximum", port.maximum},
          {"unit", name_of(port.unit)},
          {"modules", json_of(port.modules)},
          {"description", port.description}};
}

Json json_of_functions() {
  Json rows = Json::array();
  for (std::size_t i = 0; i < lang::function_count; ++i) {
    rows.push_back({{"name", lang::functions[i].name}, {"description", lang::functions[i].description}});
  }
  return rows;
}

template <class Row, std::size_t count>
Json json_of_table(const Row (&table)[count]) {
  Json rows = Json::array();
  for (const Row& row : table) rows.push_back(json_of(row));
  return rows;
}

template <class Row, std::size_t count>
Json json_of_parameters(const Row (&table)[count]) {
  Json rows = Json::array();
  for (const Row& row : table) rows.push_back(json_of_parameter(row));
  return rows;
}

}  // namespace

std::string spec_as_json() {
  const Json spec{{"modules", json_of_table(modules)},
                  {"instructions", json_of_table(instructions)},
                  {"axis_parameters", json_of_parameters(axis_parameters)},
                  {"global_parameters", json_of_parameters(global_parameters)},
                  {"user_variables",
                   {{"bank", static_cast<unsigned>(Bank::user_variables)},
                    {"count", user_variable_count},
                    {"stored", stored_user_variable_count}}},
                  {"coordinates", {{"count", coordinate_count}}},
                  {"interrupts", json_of_table(interrupts)},
                  {"status_codes", json_of_table(status_codes)},
                  {"io_ports", json_of_table(io_ports)},
                  {"functions", json_of_functions()}};
  return spec.dump(2);
}

}  // namespace opentmcl::app
