#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "twin/world/quantities.hpp"

namespace opentmcl::scenario {

/// What a recording has in a row or a column.
struct RecordedSignal {
  std::string name;
  const twin::Quantity* quantity;  ///< nullptr: only in the trace
};

/// How a recording is written down: each returns the text to append. Ticks never run backwards; they count from the
/// begin of the run.
class RecordingFormat {
 public:
  virtual ~RecordingFormat() = default;

  /// Everything before the first change. @param values of all signals, in their order
  virtual std::string begin(std::span<const RecordedSignal> signals, twin::Tick tick,
                            std::span<const double> values) = 0;
  virtual std::string change(twin::Tick tick, std::size_t signal, double value) = 0;
  virtual std::string end(twin::Tick tick) = 0;
};

/// Seconds with all their digits: a tick is 62.5 ns.
std::string seconds_text(twin::Tick tick);

}  // namespace opentmcl::scenario
