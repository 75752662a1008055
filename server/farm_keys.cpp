#include "server/farm_keys.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "boards/twin/paced_port.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "scenario/problem.hpp"
#include "scenario/section.hpp"
#include "server/farm_file.hpp"
#include "server/port_kinds.hpp"

namespace opentmcl::server {
namespace {

constexpr std::int64_t most_alike = 10'000;
constexpr std::string_view kinds[] = {pd1161.argument, tmcm1110.argument};
constexpr auto link_kinds = [] {
  std::array<std::string_view, std::size(port_kinds)> names{};
  std::transform(std::begin(port_kinds), std::end(port_kinds), names.begin(), [](const auto& row) { return row.name; });
  return names;
}();

template <class Target>
constexpr FarmKey<Target> name_key{"name", FarmValueKind::name, "What it is called; unique in the file.",
                                   [](Target& target, FarmValue&& value) { target.name = std::move(value.text); }};

void set_group(FarmDoors& doors, const std::string& text) {
  const std::size_t colon = text.rfind(':');
  doors.can_group = text.substr(0, colon);
  doors.can_port = static_cast<std::uint16_t>(std::stoul(text.substr(colon + 1)));
}

constexpr FarmKey<FarmDescription> top_keys[] = {
    {"tcp_address", FarmValueKind::text,
     "IP address at which TCP ports listen; 127.0.0.1 (this machine alone) if not given.",
     [](FarmDescription& farm, FarmValue&& value) { farm.tcp_address = std::move(value.text); }},
};

constexpr FarmKey<FarmModuleEntry> module_keys[] = {
    {"name", FarmValueKind::name, "What it is called; unique in the file.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.name = std::move(value.text); }},
    {"kind", FarmValueKind::text, "The module; pd1161 if not given.",
     [](FarmModuleEntry& entry, FarmValue&& value) {
       entry.module.kind = value.text == tmcm1110.argument ? &tmcm1110 : &pd1161;
     },
     0, 0, kinds},
    {"count", FarmValueKind::number,
     "So many alike, called NAME-1, NAME-2, ...; in paths {name} stands for that name, TCP ports and addresses on a "
     "bus "
     "count on.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.count = value.number; }, 1, most_alike},
    {"link", FarmValueKind::path, "Where to make a link to its serial port, a pseudo terminal.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.doors.link = std::move(value.text); }},
    {"link_kind", FarmValueKind::text, "What that serial port stands for; usb if not given. rs232: pd1161 alone.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.link_kind = find_port_kind(value.text)->kind; }, 0, 0,
     link_kinds},
    {"tcp", FarmValueKind::number, "TCP port; 0: any free one.",
     [](FarmModuleEntry& entry, FarmValue&& value) {
       entry.module.doors.tcp = static_cast<std::uint16_t>(value.number);
     },
     0, highest_tcp_port},
    {"wire", FarmValueKind::number, "bit/s of the serial port and of TCP: bytes take their time; none if not given.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.wire = static_cast<std::uint32_t>(value.number); },
     PacedPort::slowest_rate, PacedPort::fastest_rate},
    {"slcan_link", FarmValueKind::path, "tmcm1110: where to make a link to a serial CAN adapter (SLCAN).",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.doors.slcan_link = std::move(value.text); }},
    {"can_udp", FarmValueKind::group, "tmcm1110: GROUP:PORT of a CAN bus over UDP multicast, in python-can's format.",
     [](FarmModuleEntry& entry, FarmValue&& value) { set_group(entry.module.doors, value.text); }},
    {"rs485", FarmValueKind::name, "Name of the [[rs485]] line that it is on.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.rs485 = std::move(value.text); }},
    {"can", FarmValueKind::name, "tmcm1110: name of the [[can]] bus that it is on.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.can = std::move(value.text); }},
    {"address", FarmValueKind::number,
     "Serial address and CAN identifier (global parameters 66, 71); as in the EEPROM if not given.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.address = static_cast<std::uint8_t>(value.number); },
     1, 255},
    {"program", FarmValueKind::path, "TMCL program to load.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.program = std::move(value.text); }},
    {"start", FarmValueKind::truth, "Whether the program is started; true if not given.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.starts_program = value.truth; }},
    {"eeprom", FarmValueKind::path, "File that keeps the EEPROM; made if it does not exist.",
     [](FarmModuleEntry& entry, FarmValue&& value) { entry.module.eeprom = std::move(value.text); }},
};

constexpr FarmKey<FarmRs485Line> line_keys[] = {
    name_key<FarmRs485Line>,
    {"link", FarmValueKind::path, "Where to make a link to a pseudo terminal at the end of the line.",
     [](FarmRs485Line& line, FarmValue&& value) { line.doors.link = std::move(value.text); }},
    {"tcp", FarmValueKind::number, "TCP port at the end of the line; 0: any free one.",
     [](FarmRs485Line& line, FarmValue&& value) { line.doors.tcp = static_cast<std::uint16_t>(value.number); }, 0,
     highest_tcp_port},
    {"baud_rate", FarmValueKind::number,
     "bit/s of host and modules, as global parameter 65 knows them; 9600 if not given.",
     [](FarmRs485Line& line, FarmValue&& value) { line.baud_rate = static_cast<std::uint32_t>(value.number); },
     rs485_baud_rates[0], *(std::end(rs485_baud_rates) - 1)},
};

constexpr FarmKey<FarmCanBus> bus_keys[] = {
    name_key<FarmCanBus>,
    {"slcan_link", FarmValueKind::path, "Where to make a link to a serial CAN adapter (SLCAN).",
     [](FarmCanBus& bus, FarmValue&& value) { bus.doors.slcan_link = std::move(value.text); }},
    {"can_udp", FarmValueKind::group, "GROUP:PORT of UDP multicast, in python-can's format.",
     [](FarmCanBus& bus, FarmValue&& value) { set_group(bus.doors, value.text); }},
    {"bit_rate", FarmValueKind::number, "bit/s, as global parameter 69 knows them; 1000000 if not given.",
     [](FarmCanBus& bus, FarmValue&& value) { bus.bit_rate = static_cast<std::uint32_t>(value.number); },
     can_bit_rates[1], *(std::end(can_bit_rates) - 1)},
};

template <class Target>
std::string reference(std::string_view heading, std::span<const FarmKey<Target>> keys) {
  std::string text = "### " + std::string(heading) + "\n\n| Key | Takes | Meaning |\n|---|---|---|\n";
  for (const FarmKey<Target>& key : keys) {
    text += "| `" + std::string(key.name) + "` | " + farm_expectation(key.kind, key.lowest, key.highest, key.choices) +
            " | " + std::string(key.description) + " |\n";
  }
  return text;
}

/// Rows of the sections that a [[module]] shares with a scenario.
std::string bench_reference() {
  std::string text;
  for (const scenario::SectionName& section : scenario::bench_sections()) {
    text += "| `" + std::string(section.name) + "` | as in a [scenario](scenarios.md#the-file) | " +
            std::string(section.description) + " |\n";
  }
  return text;
}

}  // namespace

std::span<const FarmKey<FarmDescription>> farm_keys() {
  return top_keys;
}

std::span<const FarmKey<FarmModuleEntry>> farm_module_keys() {
  return module_keys;
}

std::span<const FarmKey<FarmRs485Line>> farm_rs485_keys() {
  return line_keys;
}

std::span<const FarmKey<FarmCanBus>> farm_can_keys() {
  return bus_keys;
}

std::string farm_expectation(FarmValueKind kind, std::int64_t lowest, std::int64_t highest,
                             std::span<const std::string_view> choices) {
  if (!choices.empty()) return scenario::listed(choices);
  switch (kind) {
    case FarmValueKind::name:
      return "a name of letters, digits, -, _ and .";
    case FarmValueKind::text:
      return "a text";
    case FarmValueKind::path:
      return "a path";
    case FarmValueKind::group:
      return "GROUP:PORT, such as 239.74.163.2:43113";
    case FarmValueKind::truth:
      return "true or false";
    case FarmValueKind::number:
      return "a whole number, " + std::to_string(lowest) + " to " + std::to_string(highest);
  }
  return {};
}

std::string farm_file_reference() {
  return reference("At the top", farm_keys()) + '\n' + reference("[[module]]", farm_module_keys()) + bench_reference() +
         '\n' + reference("[[rs485]]: a line with several modules", farm_rs485_keys()) + '\n' +
         reference("[[can]]: a bus with several modules", farm_can_keys());
}

}  // namespace opentmcl::server
