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
  Modules modules;         ///< that have such a connector
};

/// The kinds of serial ports; CAN is none.
inline constexpr PortKindName port_kinds[] = {
    {hal::PortKind::usb, "usb", "USB", Modules::both},
    {hal::PortKind::rs485, "rs485", "RS485", Modules::both},
    {hal::PortKind::rs232, "rs232", "RS232", Modules::pd1161},
};

/// @pre it is that of a serial port
const PortKindName& names_of(hal::PortKind kind);
/// nullptr: no serial port is called so.
const PortKindName* find_port_kind(std::string_view name);

/// "usb, rs485 or rs232": what there is to choose from at a module.
std::string port_kind_choice(const ModuleDescription& module);

/// Why a module has no such connector; nothing if it has.
std::optional<std::string> absence(hal::PortKind kind, const ModuleDescription& module);

}  // namespace opentmcl::server
