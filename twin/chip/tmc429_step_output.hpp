// The STEP and DIR pins of one TMC429 axis (datasheet page 53).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/step_signal.hpp"

namespace opentmcl::twin {

class Tmc429StepOutput {
 public:
  /// The common registers that shape the signals.
  struct Settings {
    tmc429::Word<tmc429::InterfaceConfiguration> interface_configuration;
    tmc429::Word<tmc429::GlobalParameters> global_parameters = tmc429::GlobalParameters::reset;
  };

  Tmc429StepOutput(unsigned motor, StepListener& listener) : motor_(motor), listener_(&listener) {}

  void set_detail(StepDetail detail) { detail_ = detail; }
  /// The clock of each step that is given out alone is appended to `clocks`, if given.
  void list_single_steps(std::vector<std::uint64_t>* clocks) { single_step_clocks_ = clocks; }

  /// A step of the ramp generator. After a change of direction DIR moves at once and STEP one pulse length later.
  /// Nothing comes out while the chip serves SPI drivers.
  void step(std::uint64_t clock, bool decreasing, const Settings& settings);

  /// Several steps; only where the first of them is immediate().
  void steps(std::uint64_t count, std::uint64_t first_clock, std::uint64_t last_clock, const Settings& settings);
  /// A step in this direction would neither be delayed nor overtake one that is.
  bool immediate(bool decreasing) const { return !delayed_edge_ && decreasing == decreasing_; }

  /// Clock at which a delayed step is to go out, if there is one.
  const std::optional<std::uint64_t>& delayed_edge() const { return delayed_edge_; }

  /// Gives out a delayed step whose time has come by `clock`.
  void advance(std::uint64_t clock, const Settings& settings);

  /// Tells the listener what was given out and not yet told.
  void flush() {
    if (untold_.count != 0) tell();
  }

  /// Level of STEP; high while the chip serves SPI drivers.
  bool step_pin(std::uint64_t clock, const Settings& settings) const;
  /// Level of DIR; high while the chip serves SPI drivers.
  bool direction_pin(const Settings& settings) const;

 private:
  void tell();
  void give_out(std::uint64_t count, std::uint64_t first_clock, std::uint64_t last_clock, const Settings& settings);

  unsigned motor_;
  StepListener* listener_;
  bool decreasing_ = false;
  bool toggled_high_ = false;                  ///< the level with step_half, before inv_stp
  std::optional<std::uint64_t> delayed_edge_;  ///< clock at which a step after a reversal goes out
  std::optional<std::uint64_t> latest_edge_;
  StepDetail detail_ = StepDetail::runs;
  StepRun untold_{};  ///< to which further steps may be added; none where its count is 0
  std::vector<std::uint64_t>* single_step_clocks_ = nullptr;
};

}  // namespace opentmcl::twin
