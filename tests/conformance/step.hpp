// The lines that say what to do with a module and what it must answer; README.md describes the language.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "firmware/hal/can_port.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::conformance {

using Bytes = std::vector<std::uint8_t>;

/// A number that must be met exactly, or both ends of what is accepted.
struct Range {
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;

  constexpr bool contains(std::int64_t value) const { return minimum <= value && value <= maximum; }
};

/// What must come back for a command.
struct ExpectedReply {
  std::uint8_t status = 100;
  std::optional<Range> value;  ///< nothing: any value
};

/// One command in the frame of the line, and its reply; no `reply`: there must be none.
struct SendCommand {
  Command command;
  std::optional<ExpectedReply> reply;
};

/// Bytes as they are, and all that comes back for them.
struct SendBytes {
  Bytes bytes;
  Bytes reply;
};

/// A frame on the CAN bus, and the one that comes back; no `reply`: there must be none.
struct SendFrame {
  hal::CanFrame frame;
  std::optional<hal::CanFrame> reply;
};

/// Bytes that come without being asked for, such as the second reply of command 138.
struct Receive {
  Bytes bytes;
  Microseconds limit;
};

struct Wait {
  Microseconds duration;
};

/// Repeats a command each millisecond until its value is in the range.
struct WaitUntil {
  Command command;
  Range value;
  Microseconds limit;
};

/// Changes something at the bench: a switch, an input, the supply.
struct SetWorld {
  std::string name;
  std::int64_t value;
};

/// Looks at something at the bench: an output, a register of a chip, the shaft.
struct CheckWorld {
  std::string name;
  Range value;
};

struct PowerCycle {};

/// Resets the interpreter (131) and runs the program (129) from an address.
struct RunProgram {
  std::int32_t address;
};

using Action = std::variant<SendCommand, SendBytes, SendFrame, Receive, Wait, WaitUntil, SetWorld, CheckWorld,
                            PowerCycle, RunProgram>;

struct Step {
  std::string text;  ///< the line, for messages
  Action action;
};

/// @throws std::runtime_error with the line and what is wrong with it
std::vector<Step> parse_steps(std::string_view text, const ModuleDescription& module);

}  // namespace opentmcl::conformance
