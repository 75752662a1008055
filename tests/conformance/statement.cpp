#include "tests/conformance/statement.hpp"

#include <stdexcept>

namespace opentmcl::conformance {

Modules modules_named(std::string_view name) {
  if (name == "both") return Modules::both;
  if (name == pd1161.argument) return Modules::pd1161;
  if (name == tmcm1110.argument) return Modules::tmcm1110;
  throw std::runtime_error("no module is called " + std::string(name));
}

}  // namespace opentmcl::conformance
