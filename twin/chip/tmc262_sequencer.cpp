#include "twin/chip/tmc262_sequencer.hpp"

#include <algorithm>

#include "twin/chip/tmc262_choices.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::DriverControl;

/// microPlyer makes 16 microsteps of 1/256 of a step of 1/16 (chapter 8.4).
constexpr std::int32_t interpolated_resolution = 4;
constexpr std::uint64_t interpolated_microsteps = 16;

/// Those edges of a run that make a step.
struct ActiveEdges {
  std::uint64_t count;
  std::uint64_t first;     ///< edges of the run before the first of them
  std::uint64_t distance;  ///< from one to the next, in edges of the run; 0 where a pulse has two
};

ActiveEdges active_edges(const Tmc262StepRun& run, bool both_edges) {
  if (run.first == StepSignal::pulse && both_edges) return {2 * run.count, 0, 0};
  if (run.first == StepSignal::pulse || both_edges) return {run.count, 0, 1};
  const std::uint64_t skipped = run.first == StepSignal::rising ? 0 : 1;
  return {(run.count + 1 - skipped) / 2, skipped, 2};
}

/// How often a way leads over a multiple of two full steps, where a sine changes its sign.
std::uint64_t polarity_changes(std::int64_t from, std::int64_t to) {
  constexpr int half_turn_bits = 9;
  static_assert(1 << half_turn_bits == tmc262::microstep_positions / 2);
  // Shifts round down on either side of 0.
  const std::int64_t difference = (to >> half_turn_bits) - (from >> half_turn_bits);
  return static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
}

}  // namespace

std::uint64_t Tmc262StepRun::clock_of(std::uint64_t index) const {
  return count > 1 ? first_clock + index * (last_clock - first_clock) / (count - 1) : first_clock;
}

StepSignal Tmc262StepRun::signal_of(std::uint64_t index) const {
  if (first == StepSignal::pulse || index % 2 == 0) return first;
  return first == StepSignal::rising ? StepSignal::falling : StepSignal::rising;
}

std::uint64_t Tmc262StepRun::count_before(std::uint64_t clock) const {
  if (clock <= first_clock) return 0;
  if (clock > last_clock) return count;
  // The first index whose clock is not below: the least i with i duration / (count - 1) >= clock - first_clock.
  const std::uint64_t duration = last_clock - first_clock;
  return ((clock - first_clock) * (count - 1) + duration - 1) / duration;
}

Tmc262Sequencer::Movement Tmc262Sequencer::take(const Tmc262StepRun& run, bool down,
                                                const Tmc262RegisterFile& registers) {
  const ActiveEdges edges = active_edges(run, registers.steps_on_both_edges());
  if (edges.count == 0) return {};
  const std::int32_t size = tmc262_choices::microsteps_per_edge(registers.driver_control);
  const std::int64_t way = static_cast<std::int64_t>(edges.count) * (down ? -size : size);
  const std::int64_t from = position_;
  const std::int64_t to = from + way;
  constexpr std::int64_t cosine_lead = tmc262::microsteps_per_fullstep;

  const std::uint64_t last = edges.distance == 0 ? run.count - 1 : edges.first + (edges.count - 1) * edges.distance;
  const std::uint64_t last_clock = last == run.count - 1 ? run.last_clock : run.clock_of(last);
  const bool plays = interpolates(registers);
  microstep_interval_ = 0;
  plays_down_ = plays && down;
  if (plays) {
    const std::uint64_t previous_edge = edges.count > 1 ? run.clock_of(last - edges.distance) : latest_edge_;
    const std::uint64_t period = std::min(last_clock - previous_edge, std::uint64_t{tmc262::standstill_clocks});
    microstep_interval_ = period / interpolated_microsteps;
  }
  latest_edge_ = last_clock;
  position_ = static_cast<std::uint32_t>(to) % tmc262::microstep_positions;

  return {way, polarity_changes(from, to), polarity_changes(from + cosine_lead, to + cosine_lead)};
}

bool Tmc262Sequencer::interpolates(const Tmc262RegisterFile& registers) {
  return DriverControl::Interpolation::is_set(registers.driver_control) &&
         DriverControl::Resolution::in(registers.driver_control) == interpolated_resolution;
}

std::uint32_t Tmc262Sequencer::position(std::uint64_t clock) const {
  if (microstep_interval_ == 0) return position_;
  const std::uint64_t since_first = (clock - latest_edge_) / microstep_interval_;
  constexpr std::uint64_t last = interpolated_microsteps - 1;
  const auto missing = static_cast<std::uint32_t>(last - std::min(since_first, last));
  return (plays_down_ ? position_ + missing : position_ - missing) % tmc262::microstep_positions;
}

bool Tmc262Sequencer::standstill(std::uint64_t clock) const {
  return clock - latest_edge_ >= tmc262::standstill_clocks;
}

}  // namespace opentmcl::twin
