// A farm as its file describes it, checked: names are unique, buses exist, ports and addresses are in range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/hal/hal.hpp"
#include "firmware/spec/modules.hpp"
#include "scenario/bench_setup.hpp"

namespace opentmcl::server {

/// Where hosts meet a module or a bus. Empty: no such door.
struct FarmDoors {
  std::string link;                  ///< of a pseudo terminal
  std::optional<std::uint16_t> tcp;  ///< port; 0: any free one
  std::string slcan_link;            ///< of a second pseudo terminal, a serial CAN adapter
  std::string can_group;             ///< UDP multicast group, in python-can's format
  std::uint16_t can_port = 0;        ///< its port

  bool has_serial() const { return !link.empty() || tcp.has_value(); }
  bool has_can() const { return !slcan_link.empty() || !can_group.empty(); }
};

struct FarmModule {
  std::string name;
  const ModuleDescription* kind = &pd1161;
  FarmDoors doors;
  hal::PortKind link_kind = hal::PortKind::usb;  ///< what the pseudo terminal stands for
  std::optional<std::uint32_t> wire;             ///< bit/s of that line and of TCP; none: bytes take no time
  std::optional<std::size_t> rs485;              ///< the line it is on, of FarmDescription::rs485_lines
  std::optional<std::size_t> can;                ///< the bus it is on, of FarmDescription::can_buses
  std::optional<std::uint8_t> address;           ///< serial address, on CAN the identifier; none: as in its EEPROM
  std::string program;                           ///< TMCL source; empty: none
  bool starts_program = true;
  std::string eeprom;  ///< file behind the EEPROM; empty: fresh from the factory each time
  /// What its motor is and turns; shared by those alike.
  std::shared_ptr<const scenario::BenchSetup> bench = std::make_shared<scenario::BenchSetup>();
};

struct FarmRs485Line {
  std::string name;
  FarmDoors doors;
  std::uint32_t baud_rate = 9600;  ///< bit/s, one of rs485_baud_rates
};

struct FarmCanBus {
  std::string name;
  FarmDoors doors;
  std::uint32_t bit_rate = 1'000'000;  ///< bit/s, one of can_bit_rates
};

struct FarmDescription {
  std::string tcp_address = "127.0.0.1";  ///< where TCP ports listen
  std::vector<FarmRs485Line> rs485_lines;
  std::vector<FarmCanBus> can_buses;
  std::vector<FarmModule> modules;
};

}  // namespace opentmcl::server
