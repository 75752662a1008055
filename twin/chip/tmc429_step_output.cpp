#include "twin/chip/tmc429_step_output.hpp"

#include <algorithm>
#include <utility>

#include "twin/chip/tmc429_choices.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::GlobalParameters;
using tmc429::InterfaceConfiguration;
using Settings = Tmc429StepOutput::Settings;

bool enabled(const Settings& settings) {
  return InterfaceConfiguration::EnableStepDir::is_set(settings.interface_configuration);
}

bool steps_on_both_edges(const Settings& settings) {
  return InterfaceConfiguration::StepOnBothEdges::is_set(settings.interface_configuration);
}

bool step_inverted(const Settings& settings) {
  return InterfaceConfiguration::InvertStep::is_set(settings.interface_configuration);
}

/// t_STEP = 16 (1 + STPDIV) clocks, page 53.
std::uint64_t pulse_length(const Settings& settings) {
  return 16u * (1u + static_cast<unsigned>(GlobalParameters::StepPulseLength::in(settings.global_parameters)));
}

}  // namespace

void Tmc429StepOutput::step(std::uint64_t clock, bool decreasing, const Settings& settings) {
  if (delayed_edge_) {
    const std::uint64_t edge = std::min(*delayed_edge_, clock);
    give_out(1, edge, edge, settings);
  }
  const bool reversed = decreasing != decreasing_;
  decreasing_ = decreasing;
  if (reversed) {
    delayed_edge_ = clock + pulse_length(settings);
  } else {
    give_out(1, clock, clock, settings);
  }
}

void Tmc429StepOutput::steps(std::uint64_t count, std::uint64_t first_clock, std::uint64_t last_clock,
                             const Settings& settings) {
  give_out(count, first_clock, last_clock, settings);
}

void Tmc429StepOutput::advance(std::uint64_t clock, const Settings& settings) {
  if (delayed_edge_ && *delayed_edge_ <= clock) {
    give_out(1, *delayed_edge_, *delayed_edge_, settings);
  }
}

void Tmc429StepOutput::give_out(std::uint64_t count, std::uint64_t first_clock, std::uint64_t last_clock,
                                const Settings& settings) {
  delayed_edge_.reset();
  if (!enabled(settings)) {
    return;
  }
  latest_edge_ = last_clock;
  StepSignal signal = StepSignal::pulse;
  if (steps_on_both_edges(settings)) {
    signal = toggled_high_ == step_inverted(settings) ? StepSignal::rising : StepSignal::falling;
    toggled_high_ = toggled_high_ != (count % 2 == 1);
  }
  if (count == 1 && single_step_clocks_ != nullptr) {
    single_step_clocks_->push_back(first_clock);
  }
  const bool direction = direction_pin(settings);
  if (untold_.count != 0 && untold_.direction == direction) {
    untold_.count += count;
    untold_.last_clock = last_clock;
  } else {
    flush();
    untold_ = StepRun{motor_, count, first_clock, last_clock, signal, direction};
  }
  if (detail_ == StepDetail::edges) {
    flush();
  }
}

void Tmc429StepOutput::tell() {
  // The listener may set switches: by then there must be nothing left to tell.
  const StepRun run = std::exchange(untold_, {});
  listener_->steps(run);
}

bool Tmc429StepOutput::step_pin(std::uint64_t clock, const Settings& settings) const {
  if (!enabled(settings)) {
    return true;
  }
  const bool in_pulse = latest_edge_ && clock < *latest_edge_ + pulse_length(settings);
  const bool high = steps_on_both_edges(settings) ? toggled_high_ : in_pulse;
  return high != step_inverted(settings);
}

bool Tmc429StepOutput::direction_pin(const Settings& settings) const {
  const bool inverted = InterfaceConfiguration::InvertDirection::is_set(settings.interface_configuration);
  return !enabled(settings) || tmc429_choices::direction_pin(decreasing_, inverted);
}

}  // namespace opentmcl::twin
