// Recordings as a value change dump, IEEE 1364-2005 chapter 18, which GTKWave and others show.
#pragma once

#include <string>
#include <vector>

#include "scenario/recording_format.hpp"

namespace opentmcl::scenario {

/// Truths are wires, whole numbers integers of 64 bits in two's complement, other numbers reals. The part of a name
/// before its last dot is a scope. The unit of time is 100 ps: a tick, 62.5 ns, is 625 of them. Nothing in the file
/// tells when or where it was made, so equal runs give equal bytes.
class Vcd final : public RecordingFormat {
 public:
  static constexpr twin::Tick units_a_tick = 625;

  std::string begin(std::span<const RecordedSignal> signals, twin::Tick tick, std::span<const double> values) override;
  std::string change(twin::Tick tick, std::size_t signal, double value) override;
  std::string end(twin::Tick tick) override;

 private:
  std::string time(twin::Tick tick);
  std::string value_change(std::size_t signal, double value) const;

  std::vector<twin::Quantity::Kind> kinds_;
  twin::Tick latest_ = 0;
};

}  // namespace opentmcl::scenario
