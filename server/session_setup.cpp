#include "server/session_setup.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "boards/twin/paced_port.hpp"
#include "firmware/spec/lookup.hpp"
#include "scenario/scenario_file.hpp"
#include "scenario/section.hpp"
#include "server/hexadecimal.hpp"
#include "server/open_transport.hpp"
#include "server/port_kinds.hpp"

namespace opentmcl::server {

namespace {

/// As many as a VirtualModule takes.
constexpr std::size_t most_ports = 4;

using client::Error;
using client::ErrorKind;
using client::Result;
using nlohmann::json;
using nlohmann::ordered_json;
using twin::Eeprom;

bool is_blank(std::span<const std::uint8_t> page) {
  return std::all_of(page.begin(), page.end(), [](std::uint8_t byte) { return byte == Eeprom::erased; });
}

/// The pages that are not blank, by their addresses.
ordered_json pages_of(const EepromFile::Image& image) {
  ordered_json pages = ordered_json::object();
  for (std::size_t address = 0; address < image.size(); address += Eeprom::page_size) {
    const auto page = std::span(image).subspan(address, Eeprom::page_size);
    if (!is_blank(page)) pages[std::to_string(address)] = hexadecimal(page);
  }
  return pages;
}

Error bad(const std::string& what) {
  return {ErrorKind::bad_file, what, {}};
}

std::optional<std::size_t> page_address_of(const std::string& text) {
  if (text.empty() || text.size() > 5 || text.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  const std::size_t address = std::stoul(text);
  if (address >= Eeprom::size || address % Eeprom::page_size != 0) return std::nullopt;
  return address;
}

std::optional<Error> read_pages(const json& pages, EepromFile::Image& image) {
  for (const auto& [key, value] : pages.items()) {
    const std::optional<std::size_t> address = page_address_of(key);
    const auto bytes = value.is_string() ? bytes_of_hexadecimal(value.get_ref<const std::string&>()) : std::nullopt;
    if (!address || !bytes || bytes->size() != Eeprom::page_size) {
      return bad("the EEPROM's page \"" + key + "\" is no page of 64 bytes at a multiple of 64");
    }
    std::copy(bytes->begin(), bytes->end(), image.begin() + static_cast<std::ptrdiff_t>(*address));
  }
  return std::nullopt;
}

/// With the machine and the motor, and nothing happens.
Result<scenario::Scenario> plain_scenario(const SessionSetup& setup) {
  scenario::Scenario plain;
  plain.module = setup.module;
  bool is_known = false;
  scenario::for_each_machine_kind([&](const scenario::MachineKind& kind, auto, const auto& dimensions) {
    if (kind.name != setup.machine) return;
    plain.machine = dimensions;
    is_known = true;
  });
  if (!is_known) return bad("there is no machine \"" + setup.machine + "\"");
  if (setup.motor == scenario::ideal_motor) {
    plain.motor.reset();
  } else if (const twin::MotorData* const motor = twin::find_motor(setup.motor)) {
    plain.motor = *motor;
  } else {
    return bad("there is no motor \"" + setup.motor + "\"");
  }
  return plain;
}

/// As `tmcl sim` can have it. Throws json::exception.
Result<SessionSetup::Port> port_from(const json& source, const ModuleDescription& module) {
  const auto name = source.at("kind").get<std::string>();
  const PortKindName* const kind = find_port_kind(name);
  if (kind == nullptr) return bad("it has a port of kind \"" + name + "\": expected " + port_kind_choice(module));
  if (const auto objection = absence(kind->kind, module)) return bad("one of its ports cannot be: " + *objection);
  const auto wire = source.find("wire");
  if (wire == source.end()) return SessionSetup::Port{kind->kind};
  const std::int64_t rate = wire->is_number_integer() ? wire->get<std::int64_t>() : 0;
  if (rate < PacedPort::slowest_rate || rate > PacedPort::fastest_rate) {
    return bad("it has a line of " + wire->dump() + " bit/s: expected " + std::to_string(PacedPort::slowest_rate) +
               " to " + std::to_string(PacedPort::fastest_rate));
  }
  return SessionSetup::Port{kind->kind, static_cast<std::uint32_t>(rate)};
}

}  // namespace

EepromFile::Image SessionSetup::blank_eeprom() {
  EepromFile::Image image{};
  image.fill(Eeprom::erased);
  return image;
}

Result<scenario::Scenario> scenario_of(const SessionSetup& setup) {
  if (setup.scenario.empty()) return plain_scenario(setup);
  scenario::ScenarioFile file = scenario::read_scenario(setup.scenario);
  if (!file.scenario) return bad(scenario::format(file.problems, setup.scenario_name));
  if (file.scenario->module != setup.module) return bad(setup.scenario_name + " is not of a " + setup.module->name);
  return *std::move(file.scenario);
}

ordered_json to_json(const SessionSetup& setup) {
  ordered_json ports = ordered_json::array();
  for (const SessionSetup::Port& port : setup.ports) {
    ordered_json described{{"kind", names_of(port.kind).name}};
    if (port.wire != 0) described["wire"] = port.wire;
    ports.push_back(std::move(described));
  }
  ordered_json json{{"module", setup.module->argument}};
  if (setup.scenario.empty()) {
    json["machine"] = setup.machine;
    json["motor"] = setup.motor;
  } else {
    json["scenario"] = {{"name", setup.scenario_name}, {"text", setup.scenario}};
  }
  json["turn"] = setup.turn;
  json["ports"] = std::move(ports);
  json["can"] = setup.has_can;
  json["eeprom"] = pages_of(setup.eeprom);
  return json;
}

Result<SessionSetup> session_setup_from(const json& source) {
  SessionSetup setup;
  try {
    const auto module = source.at("module").get<std::string>();
    setup.module = find_module(module);
    if (setup.module == nullptr) return bad("it is of a module \"" + module + "\" that is not known here");
    if (const auto scenario = source.find("scenario"); scenario != source.end()) {
      setup.scenario_name = scenario->at("name").get<std::string>();
      setup.scenario = scenario->at("text").get<std::string>();
    } else {
      setup.machine = source.at("machine").get<std::string>();
      setup.motor = source.at("motor").get<std::string>();
    }
    if (const Result<scenario::Scenario> scenario = scenario_of(setup); !scenario) return scenario.error();
    setup.turn = source.at("turn").get<Microseconds>();
    if (setup.turn == 0) return bad("it has turns of 0 us");
    for (const json& described : source.at("ports")) {
      const Result<SessionSetup::Port> port = port_from(described, *setup.module);
      if (!port) return port.error();
      setup.ports.push_back(*port);
    }
    if (setup.ports.size() > most_ports) {
      return bad("it has " + std::to_string(setup.ports.size()) + " ports: expected at most " +
                 std::to_string(most_ports));
    }
    setup.has_can = source.at("can").get<bool>();
    if (setup.has_can && !has_can(setup.module->id)) {
      return bad("it has CAN, which a " + std::string(setup.module->name) + " lacks");
    }
    if (const auto error = read_pages(source.at("eeprom"), setup.eeprom)) return *error;
  } catch (const json::exception& error) {
    return bad(std::string("its setup is incomplete or damaged: ") + error.what());
  }
  return setup;
}

}  // namespace opentmcl::server
