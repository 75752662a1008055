#include "server/port_kinds.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "scenario/problem.hpp"

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

std::string port_kind_choice(const ModuleDescription& module) {
  std::vector<std::string_view> names;
  for (const PortKindName& row : port_kinds) {
    if (contains(row.modules, module.id)) names.push_back(row.name);
  }
  return scenario::listed(names);
}

std::optional<std::string> absence(hal::PortKind kind, const ModuleDescription& module) {
  const PortKindName& names = names_of(kind);
  if (contains(names.modules, module.id)) return std::nullopt;
  return "a " + std::string(module.name) + " has no " + std::string(names.title) + ": expected " +
         port_kind_choice(module);
}

}  // namespace opentmcl::server
