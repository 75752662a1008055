#pragma once

#include <cstdint>

#include "firmware/hal/time.hpp"

namespace opentmcl {

/// Notices when no command has come for too long (global parameters 68 and 82).
class Heartbeat {
 public:
  /// A command came, or the supervision starts.
  void note(Microseconds now) { last_ = now; }

  /// @param limit longest silence in ms; 0: any
  bool is_missing(Microseconds now, std::int32_t limit) const { return limit != 0 && now >= due(limit); }

  /// When the silence will have lasted too long; never without a limit.
  Microseconds due(std::int32_t limit) const {
    return limit == 0 ? never : last_ + static_cast<Microseconds>(limit) * one_millisecond;
  }

 private:
  Microseconds last_ = 0;
};

}  // namespace opentmcl
