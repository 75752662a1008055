#include "twin/world/trace.hpp"

namespace opentmcl::twin {

void TraceText::changed(Tick tick, std::string_view signal, std::int64_t value) {
  text_ += std::to_string(tick);
  text_ += ' ';
  text_ += signal;
  text_ += ' ';
  text_ += std::to_string(value);
  text_ += '\n';
}

}  // namespace opentmcl::twin
