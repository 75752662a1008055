#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "firmware/hal/can_port.hpp"
#include "firmware/hal/time.hpp"

namespace opentmcl::server {

/// The firmware takes a turn because something has come; what it reads in it follows as events of their own.
struct ExtraTurn {
  friend bool operator==(const ExtraTurn&, const ExtraTurn&) = default;
};

/// The firmware reads bytes from a port, in one call.
struct BytesRead {
  unsigned port = 0;
  std::vector<std::uint8_t> bytes;

  friend bool operator==(const BytesRead&, const BytesRead&) = default;
};

struct FrameRead {
  hal::CanFrame frame;

  friend bool operator==(const FrameRead& left, const FrameRead& right);
};

/// Somebody changes quantities of the world, all at once, in their units.
struct QuantitiesSet {
  struct Value {
    std::string quantity;
    double value = 0;

    friend bool operator==(const Value&, const Value&) = default;
  };
  std::vector<Value> values;

  friend bool operator==(const QuantitiesSet&, const QuantitiesSet&) = default;
};

/// The time of the scenario begins, in which its events happen.
struct ScenarioBegun {
  Microseconds duration = 0;  ///< 0: it has no end

  friend bool operator==(const ScenarioBegun&, const ScenarioBegun&) = default;
};

struct PowerCycled {
  friend bool operator==(const PowerCycled&, const PowerCycled&) = default;
};

/// Nothing happened; what the module has answered so far and the world as it is now.
struct Check {
  std::uint64_t replies = 0;  ///< digest of all that was written to the ports
  std::uint64_t state = 0;    ///< twin::digest_of()

  friend bool operator==(const Check&, const Check&) = default;
};

/// The same at the end of a session that was not cut off.
struct SessionEnd {
  Check check;

  friend bool operator==(const SessionEnd&, const SessionEnd&) = default;
};

/// One line of a session log: something that came from outside, and when in the module's time.
struct SessionEvent {
  Microseconds time = 0;
  std::variant<ExtraTurn, BytesRead, FrameRead, ScenarioBegun, QuantitiesSet, PowerCycled, Check, SessionEnd> what;

  friend bool operator==(const SessionEvent&, const SessionEvent&) = default;
};

/// As docs/session_log.md describes it, without the line's end.
std::string text_of(const SessionEvent& event);
/// Nothing if `line` is no such text.
std::optional<SessionEvent> session_event_from(std::string_view line);

}  // namespace opentmcl::server
