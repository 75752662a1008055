#include "scenario/schema.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

#include "scenario/section.hpp"
#include "scenario/unit.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::scenario {
namespace {

using Json = nlohmann::ordered_json;

Json reference(const char* name) {
  return {{"$ref", std::string("#/$defs/") + name}};
}

Json number_schema(std::string_view unit, double lowest, double highest) {
  Json plain{{"type", "number"}, {"minimum", lowest}, {"maximum", highest}};
  Json text{{"type", "string"}, {"pattern", "^[-0-9.].*$"}};
  if (!unit.empty()) text["description"] = "a number with a unit: " + expected_number(unit);
  return {{"anyOf", {std::move(plain), std::move(text)}}};
}

Json assignment_schema(const twin::Quantity& quantity) {
  Json schema = number_schema(quantity.unit, quantity.lowest, quantity.highest);
  if (quantity.kind == twin::Quantity::Kind::truth) schema["anyOf"].push_back({{"type", "boolean"}});
  std::string description(quantity.description);
  if (!quantity.unit.empty()) description += " In " + std::string(quantity.unit) + '.';
  schema["description"] = description;
  return schema;
}

Json object_schema() {
  return {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
}

/// A name with dots is a quoted key or, without quotes, a table in a table.
Json assignments_schema() {
  Json schema = object_schema();
  for (const twin::Quantity& quantity : twin::quantities()) {
    if (!quantity.can_be_written()) continue;
    schema["properties"][std::string(quantity.name)] = assignment_schema(quantity);
    Json* inner = &schema;
    std::string_view rest = quantity.name;
    for (std::size_t dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
      Json& next = (*inner)["properties"][std::string(rest.substr(0, dot))];
      if (next.is_null()) next = object_schema();
      inner = &next;
      rest.remove_prefix(dot + 1);
    }
    (*inner)["properties"][std::string(rest)] = assignment_schema(quantity);
  }
  return schema;
}

Json signals_schema() {
  Json names = Json::array();
  for (const twin::Quantity& quantity : twin::quantities()) names.push_back(quantity.name);
  for (const twin::TraceOnlySignal& signal : twin::trace_only_signals()) names.push_back(signal.name);
  return {{"type", "array"}, {"items", {{"enum", std::move(names)}}}};
}

template <class Target>
Json value_schema(const Key<Target>& key) {
  switch (key.type) {
    case ValueType::text:
      return {{"type", "string"}};
    case ValueType::choice: {
      Json names = Json::array();
      for (const std::string_view name : key.choices) names.push_back(name);
      return {{"enum", std::move(names)}};
    }
    case ValueType::names:
      return reference("signals");
    case ValueType::truth:
      return {{"type", "boolean"}};
    case ValueType::time:
      return reference("time");
    case ValueType::number:
      return number_schema(key.unit, key.lowest, key.highest);
    case ValueType::whole:
      return {{"type", "integer"}, {"minimum", key.lowest}, {"maximum", key.highest}};
    case ValueType::condition:
      return reference("condition");
    case ValueType::assignments:
      return reference("assignments");
    case ValueType::command:
      return reference("command");
    case ValueType::commands:
      return {{"anyOf", {reference("command"), {{"type", "array"}, {"items", reference("command")}}}}};
  }
  return {};
}

template <class Target>
Json section_schema(std::span<const Key<Target>> keys) {
  Json schema = object_schema();
  Json required = Json::array();
  for (const Key<Target>& key : keys) {
    Json value = value_schema(key);
    value["description"] =
        (key.only_for == nullptr ? "" : key.only_for->name + std::string(": ")) + std::string(key.description);
    schema["properties"][std::string(key.name)] = std::move(value);
    if (key.required) required.push_back(key.name);
  }
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

/// One of the kinds, each with its keys, or its name alone; without `kind` it is the first.
Json machine_schema() {
  Json kinds = Json::array();
  Json names = Json::array();
  for_each_machine_kind([&kinds, &names](const MachineKind& kind, auto keys, const auto&) {
    Json schema = section_schema(keys);
    schema["description"] = kind.description;
    schema["properties"][std::string(machine_kind_key)] = {{"const", kind.name}};
    if (!kinds.empty()) schema["required"].push_back(machine_kind_key);
    kinds.push_back(std::move(schema));
    names.push_back(kind.name);
  });
  kinds.push_back({{"enum", std::move(names)}});
  return {{"anyOf", std::move(kinds)}};
}

Json motor_schema() {
  Json schema = section_schema(motor_keys());
  const Json names{{"enum", motor_names()}};
  schema["properties"][std::string(motor_name_key)] = names;
  schema["properties"][std::string(motor_name_key)]["description"] = "The first one if it is not given.";
  return {{"anyOf", {std::move(schema), names}}};
}

/// The part of the quantities' names behind the prefix.
Json load_schema() {
  return assignments_schema()["properties"][std::string(load_prefix.substr(0, load_prefix.size() - 1))];
}

Json schema_of_section(std::string_view name) {
  if (name == motor_section) return motor_schema();
  if (name == load_section) return load_schema();
  if (name == machine_section) return machine_schema();
  if (name == encoder_section) return section_schema(encoder_keys());
  if (name == record_section) return section_schema(record_keys());
  if (name == event_section) return section_schema(event_keys());
  if (name == expect_section) return section_schema(expect_keys());
  return reference("assignments");
}

std::string in_code(std::string_view text) {
  return '`' + std::string(text) + '`';
}

}  // namespace

std::string scenario_schema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "OpenTMCL scenario"}};
  schema.update(section_schema(root_keys()));
  for (const SectionName& section : sections()) {
    Json value = schema_of_section(section.name);
    if (section.repeated) value = {{"type", "array"}, {"items", std::move(value)}};
    value["description"] = section.description;
    schema["properties"][std::string(section.name)] = std::move(value);
  }
  schema["$defs"] = {
      {"time", {{"type", "string"}, {"pattern", "^[0-9.].*[a-zµ]$"}, {"description", "a time such as 2.5 s or 30 ms"}}},
      {"condition", {{"type", "string"}, {"description", "such as: position > 40000 and not left_switch"}}},
      {"command", {{"type", "string"}, {"description", "a TMCL command such as ROR 0, 500"}}},
      {"signals", signals_schema()},
      {"assignments", assignments_schema()}};
  return schema.dump(2) + '\n';
}

namespace {

std::string_view traced_when(const twin::Quantity& quantity) {
  if (quantity.trace_scale == 0) return "";
  return quantity.follows_rotor ? "ideal motor" : "yes";
}

}  // namespace

std::string signals_document() {
  std::string text =
      "# Signals\n\n"
      "Everything around a virtual module that can be looked at, recorded, waited for and changed, by name: in a\n"
      "[scenario](scenarios.md), with `tmcl sim --record`, and in traces. Generated by `tmcl scenario signals` from\n"
      "`twin/world/quantities.cpp`; a test compares.\n\n"
      "A name that is marked as traced is recorded at the very tick at which it changes; others are looked at in\n"
      "intervals, and so is what a real motor moves. \"Can be\" is empty for what can only be looked at.\n\n"
      "| Name | Unit | Can be | Traced | What it is |\n|---|---|---|---|---|\n";
  for (const twin::Quantity& quantity : twin::quantities()) {
    std::string range;
    if (quantity.can_be_written() && quantity.kind == twin::Quantity::Kind::truth) range = "0 or 1";
    if (quantity.can_be_written() && quantity.kind != twin::Quantity::Kind::truth) {
      range = twin::text_of(quantity.lowest) + " to " + twin::text_of(quantity.highest);
    }
    text += "| " + in_code(quantity.name) + " | " + std::string(quantity.unit) + " | " + range + " | " +
            std::string(traced_when(quantity)) + " | " + std::string(quantity.description) + " |\n";
  }
  text +=
      "\nOnly in the trace, so that they can be recorded but neither looked at nor changed:\n\n"
      "| Name | What it is |\n|---|---|\n";
  for (const twin::TraceOnlySignal& signal : twin::trace_only_signals()) {
    text += "| " + in_code(signal.name) + " | " + std::string(signal.description) + " |\n";
  }
  return text;
}

}  // namespace opentmcl::scenario
