// What is done to a virtual module before hosts meet it, through its own commands and in its own time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "client/error.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "server/memory_line.hpp"

namespace opentmcl::server {

/// Loads a program from address 0 on and starts it if wanted.
/// @param simulated the module, or the line that it is on
/// @param line at a port of the module of the kind usb
/// @param module the kind it is of
client::Result<void> load_program(Simulated& simulated, MemoryLine& line, const ModuleDescription& module,
                                  const std::vector<Command>& commands, bool start);

/// What a module must be set to before it can share a bus.
struct BusSettings {
  std::optional<std::uint8_t> serial_address;    ///< global parameter 66
  std::optional<std::uint8_t> can_id;            ///< global parameter 71
  std::optional<std::uint32_t> rs485_baud_rate;  ///< bit/s; one of rs485_baud_rates
  std::optional<std::uint32_t> can_bit_rate;     ///< bit/s; one of can_bit_rates
};

/// Stores what differs in the module's EEPROM and takes the supply away and gives it back, as baud and bit rates need
/// it.
/// @param simulated, line as for load_program()
client::Result<void> set_up(Simulated& simulated, VirtualModule& module, MemoryLine& line, const BusSettings& settings);

}  // namespace opentmcl::server
