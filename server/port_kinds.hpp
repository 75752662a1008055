// What a module's serial connectors are called: on the command line, in farms and in session logs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "firmware/hal/hal.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::server {

struct PortKindName {
  hal::PortKind kind;
  std::string_view name;   ///< as users write it: "rs485"
  std::string_view title;  ///< as the manuals print it: "RS485"
};

/// The kinds of serial ports; CAN is none.
inline constexpr PortKindName port_kinds[] = {
    {hal::PortKind::usb, "usb", "USB"},
    {hal::PortKind::rs485, "rs485", "RS485"},
    {hal::PortKind::rs232, "rs232", "RS232"},
};

/// @pre it is that of a serial port
const PortKindName& names_of(hal::PortKind kind);
/// nullptr: no serial port is called so.
const PortKindName* find_port_kind(std::string_view name);

/// Why a module has no such connector; nothing if it has. Both have USB and RS485, only the PD-1161 has RS232.
std::optional<std::string> absence(hal::PortKind kind, const ModuleDescription& module);

}  // namespace opentmcl::server
