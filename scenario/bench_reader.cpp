#include "scenario/bench_reader.hpp"

#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "scenario/section.hpp"
#include "scenario/section_reader.hpp"
#include "scenario/toml_place.hpp"

namespace opentmcl::scenario {
namespace {

/// The keys of a section for which a name alone stands.
const toml::table& keys_of(const toml::node& node) {
  static const toml::table none;
  return node.is_table() ? *node.as_table() : none;
}

/// Where the section says its name, if it does: under `key`, or instead of all keys.
const toml::node* name_in(const toml::node& node, std::string_view key) {
  return node.is_table() ? node.as_table()->get(key) : &node;
}

}  // namespace

BenchSetup BenchReader::read(const toml::table& table, const ModuleDescription& module) {
  BenchSetup bench;
  if (const toml::node* const node = table.get(machine_section)) read_machine(*node, bench.machine);
  if (const toml::table* const encoder = section(table, encoder_section)) read_encoder(*encoder, module, bench.encoder);
  if (const toml::node* const node = table.get(motor_section)) read_motor(*node, bench.motor);
  values_.set_bench(module, bench);
  // Which quantities there are depends on all of the above.
  if (const toml::table* const load = section(table, load_section))
    bench.initial = values_.assignments(*load, load_prefix);
  if (const toml::table* const initial = section(table, initial_section)) {
    for (const Assignment& one : values_.assignments(*initial)) bench.initial.push_back(one);
  }
  return bench;
}

const toml::table* BenchReader::section(const toml::table& table, std::string_view name) {
  const toml::node* const node = table.get(name);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) values_.complain_of_kind(*node, "the section " + bracketed(name));
  return node->as_table();
}

bool BenchReader::is_table_or_name(const toml::node& node, std::string_view section) {
  if (node.is_table() || node.is_string()) return true;
  values_.complain_of_kind(node, "the section " + bracketed(section) + " or a name");
  return false;
}

void BenchReader::read_machine(const toml::node& node, twin::MachineDimensions& machine) {
  if (!is_table_or_name(node, machine_section)) return;
  const std::size_t problems_before = problems_.size();
  std::vector<std::string_view> kinds;
  for_each_machine_kind([&kinds](const MachineKind& kind, auto, auto) { kinds.push_back(kind.name); });
  std::string_view wanted = kinds.front();
  std::optional<Value> given;
  if (const toml::node* const name = name_in(node, machine_kind_key)) {
    given = values_.read(*name, ValueType::choice, {.choices = kinds});
    if (!given) return;
    wanted = given->text;
  }
  const toml::table& table = keys_of(node);
  for_each_machine_kind([&](const MachineKind& kind, auto keys, auto dimensions) {
    if (kind.name != wanted) return;
    read_section(values_, table, keys, dimensions, bracketed(machine_section) + " of kind " + std::string(kind.name),
                 {machine_kind_key});
    check(table, dimensions);
    if (problems_.size() == problems_before) machine = dimensions;
  });
}

void BenchReader::read_encoder(const toml::table& table, const ModuleDescription& module,
                               twin::EncoderProperties& encoder) {
  const std::size_t problems_before = problems_.size();
  read_section(values_, table, encoder_keys(), encoder, bracketed(encoder_section));
  for (const Key<twin::EncoderProperties>& key : encoder_keys()) {
    if (key.only_for == nullptr || key.only_for == &module || !table.contains(key.name)) continue;
    values_.complain(place_of(*table.get(key.name)), std::string(key.name) + " is for the encoder of a " +
                                                         key.only_for->name + ", and the module is a " + module.name);
  }
  check(table, encoder);
  if (problems_.size() != problems_before) encoder = {};
}

void BenchReader::read_motor(const toml::node& node, std::optional<twin::MotorData>& motor) {
  if (!is_table_or_name(node, motor_section)) return;
  const std::vector<std::string_view> names = motor_names();
  if (const toml::node* const name = name_in(node, motor_name_key)) {
    const std::optional<Value> given = values_.read(*name, ValueType::choice, {.choices = names});
    if (!given) return;
    const twin::MotorData* const found = twin::find_motor(given->text);
    motor = found == nullptr ? std::nullopt : std::optional(*found);
  }
  const toml::table& table = keys_of(node);
  if (motor) {
    read_section(values_, table, motor_keys(), *motor, bracketed(motor_section), {motor_name_key});
    return;
  }
  for (const auto& [key, value] : table) {
    if (key.str() == motor_name_key) continue;
    values_.complain(place_of(key.source()), "an ideal motor has no " + lang::in_quotes(key.str()) +
                                                 ": its rotor is always where the field is");
  }
}

void BenchReader::check(const toml::table& table, const twin::LinearStageDimensions& stage) {
  const auto check_place = [&](std::string_view key, std::int32_t place) {
    if (2 * std::abs(place) <= stage.travel) return;
    const toml::node* const node = table.get(key);
    constexpr double micrometres_in_a_millimetre = 1000;
    values_.complain(place_of(node == nullptr ? table : *node),
                     std::string(key) + " lies beyond a hard end: the travel is " +
                         twin::text_of(stage.travel / micrometres_in_a_millimetre) +
                         " mm, half of it on either side of 0");
  };
  check_place("start", stage.start);
  check_place("home_switch_center", stage.home_switch_center);
}

void BenchReader::check(const toml::table& table, const twin::EncoderProperties& encoder) {
  constexpr std::int32_t counts_a_line = 4;
  const auto check_count = [&](std::string_view key, std::int32_t count) {
    if (count < encoder.lines * counts_a_line) return;
    const toml::node* const node = table.get(key);
    values_.complain(place_of(node == nullptr ? table : *node),
                     std::string(key) + " must be less than a turn, which has " +
                         std::to_string(encoder.lines * counts_a_line) + " counts");
  };
  check_count("null_position", encoder.null_position);
  check_count("null_width", encoder.null_width);
}

}  // namespace opentmcl::scenario
