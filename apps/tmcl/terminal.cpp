#include "apps/tmcl/terminal.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace opentmcl::app {

bool stderr_has_colours() {
  const char* const no_color = std::getenv("NO_COLOR");
  if (no_color != nullptr && *no_color != '\0') return false;
  const char* const terminal = std::getenv("TERM");
  if (terminal == nullptr || std::string_view(terminal) == "dumb") return false;
  return ::isatty(STDERR_FILENO) != 0;
}

}  // namespace opentmcl::app
