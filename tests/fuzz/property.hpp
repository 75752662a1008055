#pragma once

#include <cstdio>
#include <cstdlib>

namespace opentmcl::fuzz {

/// Ends the process, which libFuzzer takes for a finding, when a property does not hold.
inline void require(bool holds, const char* property) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", property);
  std::abort();
}

}  // namespace opentmcl::fuzz
