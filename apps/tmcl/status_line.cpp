#include "apps/tmcl/status_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace opentmcl::app {

StatusLine::StatusLine() : is_terminal_(::isatty(STDERR_FILENO) != 0) {}

void StatusLine::show(const std::string& text) {
  if (is_terminal_) {
    constexpr const char* erase_line = "\r\033[K";
    fmt::print(stderr, "{}{}", erase_line, text);
    is_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

void StatusLine::end() {
  if (!is_open_) return;
  fmt::print(stderr, "\n");
  is_open_ = false;
}

}  // namespace opentmcl::app
