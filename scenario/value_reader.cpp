#include "scenario/value_reader.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "lang/assembler.hpp"
#include "lang/diagnostic.hpp"
#include "lang/suggestion.hpp"
#include "scenario/recorder.hpp"
#include "scenario/toml_place.hpp"
#include "scenario/unit.hpp"

namespace opentmcl::scenario {
namespace {

/// More than a century: no sum of two such times overflows.
constexpr double longest_time = 1e16;  // us

/// What an array or table of a quantity's assignments can be nested: "left_switch.held_open" is two levels.
constexpr int deepest_name = 4;

}  // namespace

ValueReader::ValueReader(ProblemList& problems) : problems_(problems) {
  set_bench(pd1161, {});
}

void ValueReader::set_bench(const ModuleDescription& module, const BenchSetup& bench) {
  module_ = &module;
  world_.emplace(nullptr, bench.mounted(module));
}

void ValueReader::complain_of_kind(const toml::node& node, std::string_view expected) {
  complain(place_of(node), "expected " + std::string(expected) + ", found " + std::string(kind_of(node)));
}

std::optional<Value> ValueReader::read(const toml::node& node, ValueType type, const AllowedValues& allowed) {
  switch (type) {
    case ValueType::text:
      return text(node);
    case ValueType::choice:
      return choice(node, allowed.choices);
    case ValueType::names:
      return names(node);
    case ValueType::truth:
      if (const auto truth = node.value_exact<bool>()) return Value{.truth = *truth};
      complain_of_kind(node, "true or false");
      return std::nullopt;
    case ValueType::time:
      return time(node, allowed.lowest);
    case ValueType::number:
      return number(node, allowed.unit, allowed.lowest, allowed.highest);
    case ValueType::whole:
      return whole(node, allowed);
    case ValueType::condition:
      return condition(node);
    case ValueType::assignments:
      if (node.is_table()) return Value{.assignments = assignments(*node.as_table())};
      complain_of_kind(node, "a table of quantities, such as { supply_voltage = \"18 V\" }");
      return std::nullopt;
    case ValueType::command:
      if (auto command = host_command(node)) return Value{.commands = {*std::move(command)}};
      return std::nullopt;
    case ValueType::commands:
      return commands(node);
  }
  return std::nullopt;
}

std::optional<Value> ValueReader::text(const toml::node& node) {
  if (const auto content = node.value_exact<std::string>()) return Value{.text = *content};
  complain_of_kind(node, "a text");
  return std::nullopt;
}

std::optional<Value> ValueReader::choice(const toml::node& node, std::span<const std::string_view> choices) {
  std::optional<Value> value = text(node);
  if (!value || std::find(choices.begin(), choices.end(), value->text) != choices.end()) return value;
  lang::Suggestion suggestion(value->text);
  for (const std::string_view name : choices) suggestion.consider(name);
  const std::string hint = suggestion.text();
  complain(place_of(node), "expected " + listed(choices) + ", found " + lang::in_quotes(value->text) +
                               (hint.empty() ? "" : "; " + hint));
  return std::nullopt;
}

std::optional<Value> ValueReader::names(const toml::node& node) {
  const toml::array* const array = node.as_array();
  if (array == nullptr) {
    complain_of_kind(node, "an array of names");
    return std::nullopt;
  }
  Value value;
  for (const toml::node& element : *array) {
    std::optional<Value> name = text(element);
    if (!name) continue;
    if (const std::optional<std::string> objection = objection_to_signal(name->text, *world_)) {
      complain(place_of(element), *objection);
    }
    value.texts.push_back(std::move(name->text));
  }
  return value;
}

std::optional<double> ValueReader::any_number(const toml::node& node, std::string_view unit) {
  if (const auto value = node.value<double>(); value && node.is_number()) return value;
  const auto content = node.value_exact<std::string>();
  if (!content) {
    complain_of_kind(node, expected_number(unit));
    return std::nullopt;
  }
  const Parsed<double> parsed = parse_number(*content, unit);
  if (const auto* const value = std::get_if<double>(&parsed)) return *value;
  const auto& error = std::get<TextError>(parsed);
  complain(place_within(node, error.offset), error.message);
  return std::nullopt;
}

std::optional<Value> ValueReader::number(const toml::node& node, std::string_view unit, double lowest, double highest) {
  const std::optional<double> value = any_number(node, unit);
  if (!value) return std::nullopt;
  if (*value >= lowest && *value <= highest) return Value{.number = *value};
  complain(place_of(node), "expected " + twin::text_of(lowest) + " to " + twin::text_of(highest) +
                               (unit.empty() ? "" : ' ' + std::string(unit)) + ", found " + twin::text_of(*value));
  return std::nullopt;
}

std::optional<Value> ValueReader::whole(const toml::node& node, const AllowedValues& allowed) {
  std::optional<Value> value = number(node, allowed.unit, allowed.lowest, allowed.highest);
  if (!value || value->number == std::trunc(value->number)) return value;
  complain(place_of(node), "expected a whole number, found " + twin::text_of(value->number));
  return std::nullopt;
}

std::optional<Value> ValueReader::time(const toml::node& node, double lowest) {
  const auto content = node.value_exact<std::string>();
  const Parsed<double> parsed = content ? parse_number(*content, "us") : Parsed<double>(0.0);
  if (const auto* const error = std::get_if<TextError>(&parsed)) {
    complain(place_within(node, error->offset), R"(expected a time such as "2.5 s" or "30 ms")");
    return std::nullopt;
  }
  const double microseconds = std::get<double>(parsed);
  const bool has_unit = content && !content->empty() && (content->back() < '0' || content->back() > '9');
  if (!has_unit || microseconds < 0 || microseconds > longest_time) {
    complain(place_of(node), R"(expected a time such as "2.5 s" or "30 ms")");
    return std::nullopt;
  }
  if (microseconds < lowest) {
    complain(place_of(node), "expected a time greater than 0");
    return std::nullopt;
  }
  return Value{.time = static_cast<Microseconds>(std::llround(microseconds))};
}

std::optional<Value> ValueReader::condition(const toml::node& node) {
  const auto content = node.value_exact<std::string>();
  if (!content) {
    complain_of_kind(node, "a condition such as \"position > 40000\"");
    return std::nullopt;
  }
  Parsed<Condition> parsed = parse_condition(*content);
  if (const auto* const error = std::get_if<TextError>(&parsed)) {
    complain(place_within(node, error->offset), error->message);
    return std::nullopt;
  }
  auto& condition = std::get<Condition>(parsed);
  for (const auto& all : condition.alternatives) {
    for (const Comparison& one : all) {
      for (const twin::Quantity* const quantity : {one.left, one.right}) {
        if (quantity == nullptr) continue;
        if (const auto reason = twin::absence(*quantity, *world_))
          complain(place_within(node, one.offset), std::string(quantity->name) + ' ' + *reason);
      }
    }
  }
  return Value{.condition = std::move(condition)};
}

// ---- Quantities

std::vector<Assignment> ValueReader::assignments(const toml::table& table, std::string_view prefix) {
  std::vector<std::pair<Place, Assignment>> found;
  add_assignments(table, std::string(prefix), 0, found);
  // toml++ sorts the keys; here the order is that of the file.
  std::stable_sort(found.begin(), found.end(), [](const auto& left, const auto& right) {
    return std::tie(left.first.line, left.first.column) < std::tie(right.first.line, right.first.column);
  });
  std::vector<Assignment> result;
  result.reserve(found.size());
  for (const auto& [place, assignment] : found) result.push_back(assignment);
  return result;
}

void ValueReader::add_assignments(const toml::table& table, const std::string& prefix, int depth,
                                  std::vector<std::pair<Place, Assignment>>& found) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const Place place = place_of(key.source());
    if (const toml::table* const inner = node.as_table(); inner != nullptr && depth < deepest_name) {
      add_assignments(*inner, name + '.', depth + 1, found);
      continue;
    }
    const twin::Quantity* const quantity = twin::find_quantity(name);
    if (quantity == nullptr) {
      complain(place, no_such_quantity(name));
      continue;
    }
    const std::optional<double> value = assigned_value(node, *quantity);
    if (!value) continue;
    if (const auto reason = twin::refusal(*quantity, *world_, *value)) {
      complain(reason->starts_with("goes") || reason->starts_with("is") ? place_of(node) : place, name + ' ' + *reason);
      continue;
    }
    found.push_back({place, {quantity, *value}});
  }
}

std::optional<double> ValueReader::assigned_value(const toml::node& node, const twin::Quantity& quantity) {
  if (quantity.kind == twin::Quantity::Kind::truth) {
    if (const auto truth = node.value_exact<bool>()) return *truth ? 1.0 : 0.0;
    if (!node.is_number()) {
      complain_of_kind(node, "true or false");
      return std::nullopt;
    }
  }
  return any_number(node, quantity.unit);
}

// ---- Commands

std::optional<HostCommand> ValueReader::host_command(const toml::node& node) {
  const auto content = node.value_exact<std::string>();
  if (!content) {
    complain_of_kind(node, "a TMCL command such as \"ROR 0, 500\"");
    return std::nullopt;
  }
  const lang::InstructionResult parsed = lang::parse_instruction(*content, *module_);
  for (const lang::Diagnostic& diagnostic : parsed.diagnostics) {
    if (diagnostic.severity() != lang::Severity::error) continue;
    const std::string note = diagnostic.note.empty() ? "" : ": " + diagnostic.note;
    complain(place_within(node, diagnostic.span.offset), diagnostic.message + note);
  }
  if (!parsed.command) return std::nullopt;
  return HostCommand{*content, *parsed.command};
}

std::optional<Value> ValueReader::commands(const toml::node& node) {
  Value value;
  const auto add = [&](const toml::node& one) {
    if (auto command = host_command(one)) value.commands.push_back(*std::move(command));
  };
  if (const toml::array* const array = node.as_array()) {
    for (const toml::node& element : *array) add(element);
  } else {
    add(node);
  }
  if (value.commands.empty()) return std::nullopt;
  return value;
}

}  // namespace opentmcl::scenario
