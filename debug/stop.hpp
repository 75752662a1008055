#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace opentmcl::debug {

/// Why a program that was let go stands again.
struct Stop {
  enum class Reason : std::uint8_t {
    entry,       ///< at the first instruction, or where an attached program was found
    step,        ///< the step is done
    breakpoint,  ///< before an instruction with a breakpoint
    change,      ///< a watched value is another one
    signal,      ///< a signal has become true
    trouble,     ///< stall, deviation or under-voltage
    pause,       ///< somebody wanted it
    limit,       ///< the time for it is over
    ended,       ///< STOP, the end of the memory, an instruction that the module does not have, or no supply
    beginning,   ///< of the history: there is nothing before it
  };

  Reason reason = Reason::step;
  std::uint16_t address = 0;     ///< of the instruction that comes next
  std::vector<int> breakpoints;  ///< numbers of those that stopped it
  std::string description;       ///< what the reason leaves open: "A: 3 -> 4", "stall"; may be empty
  bool waiting = false;          ///< the instruction is a WAIT that has begun
};

}  // namespace opentmcl::debug
