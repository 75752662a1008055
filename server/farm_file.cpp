#include "server/farm_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/lookup.hpp"
#include "lang/diagnostic.hpp"
#include "scenario/bench_reader.hpp"
#include "scenario/problem.hpp"
#include "scenario/section.hpp"
#include "scenario/toml_place.hpp"
#include "server/farm_keys.hpp"
#include "server/port_kinds.hpp"

namespace opentmcl::server {

namespace {

namespace fs = std::filesystem;

/// Where modules answer to, unless global parameters 76 and 70 say otherwise: a module with this address would take the
/// replies of the others for requests.
constexpr std::int32_t host_address =
    global_parameter_columns[static_cast<std::size_t>(pd1161.id)][row_of(GlobalParameter::serial_host_address)]
        .default_value;
static_assert(host_address ==
              global_parameter_columns[static_cast<std::size_t>(tmcm1110.id)][row_of(GlobalParameter::can_reply_id)]
                  .default_value);

using lang::in_quotes;
using scenario::listed;
using scenario::nearest_or_all;
using scenario::place_of;

bool is_name(std::string_view text) {
  constexpr std::string_view allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.";
  return !text.empty() && text.find_first_not_of(allowed) == std::string_view::npos;
}

bool is_group(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return false;
  const std::string port = text.substr(colon + 1);
  return !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos &&
         std::stoul(port) >= 1 && std::stoul(port) <= highest_tcp_port;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), folder_(fs::path(path).parent_path()) {}

  FarmFile read(std::string_view text) {
    try {
      read(toml::parse(text, path_));
    } catch (const toml::parse_error& error) {
      report(error.source(), scenario::description_of(error));
    }
    return finish();
  }

 private:
  void read(const toml::table& root) {
    for (const auto& [key, node] : root) {
      if (std::find(farm_sections, std::end(farm_sections), key.str()) == std::end(farm_sections)) continue;
      if (!node.is_array_of_tables()) {
        report(key.source(), "expected [[" + std::string(key.str()) + "]], with two brackets");
      }
    }
    std::vector<std::string_view> other_keys(std::begin(farm_sections), std::end(farm_sections));
    for (const scenario::SectionName& section : scenario::bench_sections()) {
      if (!root.contains(section.name)) continue;
      const std::string name(section.name);
      std::string objection = name + " is said of each module: expected [module.";
      objection += name + "] behind its [[module]]";
      report(root, section.name, objection);
      other_keys.push_back(section.name);
    }
    read_keys(root, farm_keys(), "a farm", file_.description, other_keys);
    for_each(root, farm_rs485_section, [this](const toml::table& table) { read_rs485_line(table); });
    for_each(root, farm_can_section, [this](const toml::table& table) { read_can_bus(table); });
    for_each(root, farm_module_section, [this](const toml::table& table) { read_module(table); });
    if (file_.description.modules.empty() && problems_.size() == 0) {
      report(root.source(), "a farm has modules: expected at least one [[module]]");
    }
  }

  FarmFile finish() {
    for (const scenario::Problem& problem : problems_.take_sorted()) {
      file_.problems.push_back(path_ + ':' + std::to_string(problem.place.line) + ':' +
                               std::to_string(problem.place.column) + ": error: " + problem.message);
    }
    return std::move(file_);
  }

  void report(const toml::source_region& where, std::string message) {
    problems_.complain(place_of(where), std::move(message));
  }
  /// At the key's value; at the section when it lacks the key.
  void report(const toml::table& table, std::string_view key, std::string message) {
    const toml::node* const node = table.get(key);
    report(node != nullptr ? node->source() : table.source(), std::move(message));
  }

  template <class Take>
  void for_each(const toml::table& root, std::string_view section, const Take& take) {
    const toml::array* const rows = root[section].as_array();
    if (rows == nullptr) return;
    for (const toml::node& row : *rows) {
      if (const toml::table* const table = row.as_table()) take(*table);
    }
  }

  template <class Target>
  void read_keys(const toml::table& table, std::span<const FarmKey<Target>> keys, const std::string& section,
                 Target& target, std::span<const std::string_view> other_keys = {}) {
    for (const auto& [name, node] : table) {
      if (std::find(other_keys.begin(), other_keys.end(), name.str()) != other_keys.end()) continue;
      const auto key =
          std::find_if(keys.begin(), keys.end(), [&name = name](const auto& each) { return each.name == name.str(); });
      if (key == keys.end()) {
        std::vector<std::string_view> known(other_keys.begin(), other_keys.end());
        for (const FarmKey<Target>& each : keys) known.push_back(each.name);
        report(name.source(),
               section + " has no key " + in_quotes(name.str()) + ": " + nearest_or_all(name.str(), known));
        continue;
      }
      if (std::optional<FarmValue> value = read_value(node, *key)) key->store(target, std::move(*value));
    }
  }

  template <class Target>
  std::optional<FarmValue> read_value(const toml::node& node, const FarmKey<Target>& key) {
    const auto refuse = [&](const std::string& found) -> std::optional<FarmValue> {
      report(node.source(), std::string(key.name) + " is " + found + ": expected " +
                                farm_expectation(key.kind, key.lowest, key.highest, key.choices));
      return std::nullopt;
    };
    FarmValue value;
    if (key.kind == FarmValueKind::truth) {
      if (!node.is_boolean()) return refuse("no truth value");
      value.truth = node.as_boolean()->get();
      return value;
    }
    if (key.kind == FarmValueKind::number) {
      if (!node.is_integer()) return refuse("no whole number");
      value.number = node.as_integer()->get();
      if (value.number < key.lowest || value.number > key.highest) return refuse(std::to_string(value.number));
      return value;
    }
    if (!node.is_string()) return refuse("no text");
    value.text = node.as_string()->get();
    if (!key.choices.empty() && std::find(key.choices.begin(), key.choices.end(), value.text) == key.choices.end()) {
      report(node.source(), "no " + std::string(key.name) + " is called " + in_quotes(value.text) + ": " +
                                nearest_or_all(value.text, key.choices));
      return std::nullopt;
    }
    const bool is_good = key.kind == FarmValueKind::name    ? is_name(value.text)
                         : key.kind == FarmValueKind::group ? is_group(value.text)
                                                            : !value.text.empty();
    if (!is_good) return refuse(in_quotes(value.text));
    if (key.kind == FarmValueKind::path) value.text = (folder_ / value.text).string();
    return value;
  }

  static bool contains_any(const toml::table& table, std::span<const std::string_view> keys) {
    return std::any_of(keys.begin(), keys.end(), [&table](std::string_view key) { return table.contains(key); });
  }

  void read_rs485_line(const toml::table& table) {
    FarmRs485Line line;
    read_keys(table, farm_rs485_keys(), "an [[rs485]] line", line);
    check_name(table, line.name);
    check_rate(table, "baud_rate", rs485_baud_rates, line.baud_rate);
    constexpr std::string_view door_keys[] = {"link", "tcp"};
    if (!contains_any(table, door_keys)) report(table.source(), "the line has no door: expected link or tcp");
    note_doors(table, line.doors);
    file_.description.rs485_lines.push_back(std::move(line));
  }

  void read_can_bus(const toml::table& table) {
    FarmCanBus bus;
    read_keys(table, farm_can_keys(), "a [[can]] bus", bus);
    check_name(table, bus.name);
    check_rate(table, "bit_rate", std::span(can_bit_rates).subspan(2), bus.bit_rate);
    constexpr std::string_view door_keys[] = {"slcan_link", "can_udp"};
    if (!contains_any(table, door_keys)) report(table.source(), "the bus has no door: expected slcan_link or can_udp");
    note_doors(table, bus.doors);
    file_.description.can_buses.push_back(std::move(bus));
  }

  void read_module(const toml::table& table) {
    FarmModuleEntry entry;
    std::vector<std::string_view> bench_keys;
    for (const scenario::SectionName& section : scenario::bench_sections()) bench_keys.push_back(section.name);
    read_keys(table, farm_module_keys(), "a [[module]]", entry, bench_keys);
    FarmModule& module = entry.module;
    module.bench = std::make_shared<scenario::BenchSetup>(bench_.read(table, *module.kind));
    if (module.name.empty()) check_name(table, module.name);
    if (!entry.rs485.empty())
      module.rs485 = find_bus(table, farm_rs485_section, entry.rs485, file_.description.rs485_lines);
    if (!entry.can.empty()) module.can = find_bus(table, farm_can_section, entry.can, file_.description.can_buses);
    const std::size_t problems = problems_.size();
    check_module(table, entry);
    for (std::int64_t number = 1; number <= entry.count; ++number) {
      file_.description.modules.push_back(multiplied(table, entry, number));
      // One message is enough for many alike.
      if (problems_.size() > problems) break;
    }
  }

  void check_module(const toml::table& table, const FarmModuleEntry& entry) {
    const FarmModule& module = entry.module;
    const FarmDoors& doors = module.doors;
    const bool is_on_bus = !entry.rs485.empty() || !entry.can.empty();
    constexpr std::string_view door_keys[] = {"link", "tcp", "slcan_link", "can_udp", "rs485", "can"};
    if (!contains_any(table, door_keys)) {
      report(table.source(), "the module has no door: expected " + listed(door_keys));
    }
    if (!has_can(module.kind->id)) {
      for (const std::string_view key : {"slcan_link", "can_udp", "can"}) {
        if (table.contains(key)) {
          report(
              table, key,
              "a " + std::string(module.kind->name) + " has no CAN: expected kind = " + in_quotes(tmcm1110.argument));
        }
      }
    }
    if (!entry.can.empty() && doors.has_can()) {
      report(table, "can", "the module has one CAN connector: expected a bus or doors of its own");
    }
    if (const auto objection = absence(module.link_kind, *module.kind)) report(table, "link_kind", *objection);
    if (table.contains("link_kind") && doors.link.empty()) {
      report(table, "link_kind", "link_kind is for a module with a link");
    }
    if (module.wire && !doors.has_serial()) {
      report(table, "wire", "wire is for a module with link or tcp; a line has its baud_rate");
    }
    for (const auto& [key, path] : {std::pair{"link", &doors.link}, std::pair{"slcan_link", &doors.slcan_link},
                                    std::pair{"eeprom", &module.eeprom}}) {
      if (entry.count > 1 && !path->empty() && path->find(farm_name_place) == std::string::npos) {
        report(table, key, "many modules cannot share it: expected {name} in the path, where each has its own name");
      }
    }
    if (!module.program.empty()) {
      std::error_code error;
      if (!fs::is_regular_file(module.program, error))
        report(table, "program", "there is no file " + in_quotes(module.program));
    }
    if (is_on_bus && !module.address && entry.count > 1) {
      report(table, "count", "many modules on a bus need addresses: expected address, that of the first");
    }
  }

  /// Number `number` of the modules that an entry stands for.
  FarmModule multiplied(const toml::table& table, const FarmModuleEntry& entry, std::int64_t number) {
    FarmModule module = entry.module;
    if (entry.count > 1) module.name += '-' + std::to_string(number);
    for (std::string* path : {&module.doors.link, &module.doors.slcan_link, &module.eeprom}) {
      const std::size_t place = path->find(farm_name_place);
      if (place != std::string::npos) path->replace(place, farm_name_place.size(), module.name);
    }
    if (!module.name.empty()) check_unique(table, "name", module.name);
    if (module.doors.tcp && *module.doors.tcp != 0) {
      const std::int64_t port = *module.doors.tcp + number - 1;
      if (port > highest_tcp_port) report(table, "tcp", "the ports count on past " + std::to_string(highest_tcp_port));
      module.doors.tcp = static_cast<std::uint16_t>(port);
    }
    if (module.rs485 || module.can) check_address(table, module, number);
    note_doors(table, module.doors);
    if (!module.eeprom.empty()) check_unique(table, "eeprom", module.eeprom);
    return module;
  }

  void check_address(const toml::table& table, FarmModule& module, std::int64_t number) {
    const std::int64_t address = module.address.value_or(1) + number - 1;
    if (address > 255) {
      report(table, "address", "the addresses count on past 255");
      return;
    }
    if (module.address) module.address = static_cast<std::uint8_t>(address);
    if (address == host_address) {
      report(table, "address",
             "address " + std::to_string(host_address) +
                 " is the host's: a module there would take the replies of others for requests");
    }
    const std::string bus =
        module.rs485 ? "rs485 " + std::to_string(*module.rs485) : "can " + std::to_string(*module.can);
    const auto [place, is_new] = addresses_.emplace(std::pair(bus, address), module.name);
    if (!is_new) {
      report(table, "address",
             "address " + std::to_string(address) + " on this bus is that of " + in_quotes(place->second));
    }
  }

  template <class Bus>
  std::optional<std::size_t> find_bus(const toml::table& table, std::string_view section, const std::string& name,
                                      const std::vector<Bus>& buses) {
    std::vector<std::string_view> known;
    for (const Bus& bus : buses) {
      if (bus.name == name) return &bus - buses.data();
      known.push_back(bus.name);
    }
    const std::string kind = "[[" + std::string(section) + "]]";
    report(table, section,
           "no " + kind + " is called " + in_quotes(name) +
               (known.empty() ? ": the file has none" : ": " + nearest_or_all(name, known)));
    return std::nullopt;
  }

  void check_name(const toml::table& table, const std::string& name) {
    if (!name.empty()) {
      check_unique(table, "name", name);
    } else if (!table.contains("name")) {
      report(table.source(), "the section lacks a name");
    }
  }

  void check_rate(const toml::table& table, std::string_view key, std::span<const std::uint32_t> known,
                  std::uint32_t rate) {
    if (std::find(known.begin(), known.end(), rate) != known.end()) return;
    std::vector<std::string> numbers;
    for (const std::uint32_t each : known) numbers.push_back(std::to_string(each));
    const std::vector<std::string_view> words(numbers.begin(), numbers.end());
    report(table, key, "no module knows " + std::to_string(rate) + " bit/s: expected " + listed(words));
  }

  void note_doors(const toml::table& table, const FarmDoors& doors) {
    if (!doors.link.empty()) check_unique(table, "link", doors.link);
    if (!doors.slcan_link.empty()) check_unique(table, "slcan_link", doors.slcan_link);
    if (doors.tcp && *doors.tcp != 0) check_unique(table, "tcp", "TCP port " + std::to_string(*doors.tcp));
  }

  /// Names, paths and ports: each may be used once.
  void check_unique(const toml::table& table, std::string_view key, const std::string& text) {
    const toml::node* const node = table.get(key);
    const auto line = node != nullptr ? node->source().begin.line : table.source().begin.line;
    const auto [place, is_new] = used_.emplace(text, line);
    if (!is_new) report(table, key, in_quotes(text) + " is taken in line " + std::to_string(place->second));
  }

  const std::string path_;
  const fs::path folder_;
  FarmFile file_;
  scenario::ProblemList problems_;
  scenario::ValueReader values_{problems_};
  scenario::BenchReader bench_{problems_, values_, "module."};
  std::map<std::string, toml::source_index> used_;                         // and in which line
  std::map<std::pair<std::string, std::int64_t>, std::string> addresses_;  // by bus and address, the module
};

}  // namespace

FarmFile read_farm(std::string_view text, const std::string& path) {
  return Reader(path).read(text);
}

}  // namespace opentmcl::server
