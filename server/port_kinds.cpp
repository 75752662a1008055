#include "server/port_kinds.hpp"

#include <algorithm>
#include <iterator>

namespace opentmcl::server {

const PortKindName& names_of(hal::PortKind kind) {
  return *std::find_if(std::begin(port_kinds), std::end(port_kinds),
                       [kind](const PortKindName& row) { return row.kind == kind; });
}

const PortKindName* find_port_kind(std::string_view name) {
  const auto* const found = std::find_if(std::begin(port_kinds), std::end(port_kinds),
                                         [name](const PortKindName& row) { return row.name == name; });
  return found == std::end(port_kinds) ? nullptr : found;
}

std::optional<std::string> absence(hal::PortKind kind, const ModuleDescription& module) {
  if (kind != hal::PortKind::rs232 || module.id == ModuleId::pd1161) return std::nullopt;
  return "a " + std::string(module.name) + " has no RS232: expected usb or rs485";
}

}  // namespace opentmcl::server
