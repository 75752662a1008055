// Recordings as comma-separated values, RFC 4180, for spreadsheets and plots.
#pragma once

#include <string>
#include <vector>

#include "scenario/recording_format.hpp"

namespace opentmcl::scenario {

/// The first line names the columns, "time [s]" and "stage [mm]"; a line follows for the begin, for each tick at which
/// a value changed, and for the end. Of several changes in one tick the last one counts.
class Csv final : public RecordingFormat {
 public:
  std::string begin(std::span<const RecordedSignal> signals, twin::Tick tick, std::span<const double> values) override;
  std::string change(twin::Tick tick, std::size_t signal, double value) override;
  std::string end(twin::Tick tick) override;

 private:
  std::string line() const;

  twin::Tick tick_ = 0;
  std::vector<double> values_;  ///< at tick_, not yet written
};

}  // namespace opentmcl::scenario
