#include "twin/world/trace.hpp"

namespace opentmcl::twin {

std::string trace_line(Tick tick, std::string_view signal, std::int64_t value) {
  std::string line = std::to_string(tick);
  line += ' ';
  line += signal;
  line += ' ';
  line += std::to_string(value);
  line += '\n';
  return line;
}

void TraceText::changed(Tick tick, std::string_view signal, std::int64_t value) {
  text_ += trace_line(tick, signal, value);
}

}  // namespace opentmcl::twin
