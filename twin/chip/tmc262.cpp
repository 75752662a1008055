#include "twin/chip/tmc262.hpp"

#include <algorithm>

#include "twin/chip/microstep_table.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::ChopperConfiguration;
using tmc262::CoilCurrents;
using tmc262::CoolStepControl;
using tmc262::DriverConfiguration;
using tmc262::DriverControl;
using tmc262::RegisterSelect;
using tmc262::Reply;
using tmc262::ReplyFormat;
using tmc262::StallGuardAndCurrent;
using tmc262::Word;

constexpr std::int32_t warning_temperature = 100;
constexpr std::int32_t shutdown_temperature = 150;
constexpr std::int32_t high_sense_voltage = 310;
constexpr std::int32_t low_sense_voltage = 165;
constexpr unsigned full_steps_per_filtered_measurement = 4;

/// Under-voltage lockout, in mV (TMC2660C datasheet 19.2).
constexpr std::int32_t reset_voltage = 7'000;

template <class Register>
bool only_sets(Word<Register> word, std::uint32_t modelled_bits) {
  return (word.bits & ~modelled_bits) == 0;
}

bool is_modelled(Word<DriverControl> word) {
  return only_sets(word, DriverControl::StepOnBothEdges::mask | DriverControl::Resolution::mask) &&
         DriverControl::Resolution::in(word) <= tmc262::maximum_resolution;
}

/// The lower current limit and the steps do nothing while SEMIN is 0.
bool is_modelled(Word<CoolStepControl> word) {
  return only_sets(word, CoolStepControl::MinimumCurrent::mask | CoolStepControl::CurrentDownStep::mask |
                             CoolStepControl::HysteresisWidth::mask | CoolStepControl::CurrentUpStep::mask);
}

bool is_modelled(Word<StallGuardAndCurrent> word) {
  return only_sets(word, StallGuardAndCurrent::Filter::mask | StallGuardAndCurrent::Threshold::mask |
                             StallGuardAndCurrent::CurrentScale::mask);
}

/// Slopes and short detection act on switching edges and faults, which an ideal motor never shows.
bool is_modelled(Word<DriverConfiguration> word) {
  return only_sets(word, DriverConfiguration::SlopeHigh::mask | DriverConfiguration::SlopeLow::mask |
                             DriverConfiguration::DisableShortProtection::mask |
                             DriverConfiguration::ShortDetectionTime::mask | DriverConfiguration::StepDirOff::mask |
                             DriverConfiguration::LowSenseVoltage::mask | DriverConfiguration::Format::mask) &&
         DriverConfiguration::reply_format_in(word) != ReplyFormat::reserved;
}

std::uint32_t microsteps_per_edge(Word<DriverControl> word) {
  return std::uint32_t{1} << std::min(DriverControl::Resolution::in(word), tmc262::maximum_resolution);
}

}  // namespace

void Tmc262::set_supply_voltage(std::int32_t millivolts) {
  has_supply_ = millivolts >= reset_voltage;
  if (!has_supply_) reset();
}

void Tmc262::reset() {
  driver_control_ = {};
  spi_coil_currents_ = {};
  chopper_configuration_ = {};
  cool_step_control_ = {};
  stall_guard_and_current_ = {};
  driver_configuration_ = {};
  microstep_position_ = 0;
  unmeasured_full_steps_ = 0;
  stall_guard_value_.reset();
}

std::uint32_t Tmc262::transfer(std::uint32_t word, std::uint64_t clock) {
  if (!has_supply_) return 0;
  const Word<Reply> answer = reply(clock);
  write(word & tmc262::word_mask);
  return answer.bits;
}

Word<Reply> Tmc262::reply(std::uint64_t clock) const {
  const std::int32_t stall_guard = stall_guard_value_.value_or(0);
  Word<Reply> answer;
  switch (DriverConfiguration::reply_format_in(driver_configuration_)) {
    case ReplyFormat::microstep_position:
    case ReplyFormat::reserved:
      answer = Reply::MicrostepPosition::of(static_cast<std::int32_t>(microstep_position_));
      break;
    case ReplyFormat::stall_guard:
      answer = Reply::StallGuardValue::of(stall_guard);
      break;
    case ReplyFormat::stall_guard_and_current:
      answer = Reply::StallGuardUpperBits::of(stall_guard >> 5) | Reply::CurrentScale::of(current_scale());
      break;
  }
  return answer | Reply::Standstill::of(clock - latest_step_clock_ >= tmc262::standstill_clocks) |
         Reply::OvertemperatureWarning::of(temperature_ >= warning_temperature) |
         Reply::Overtemperature::of(temperature_ >= shutdown_temperature) |
         Reply::StallGuardReached::of(stall_guard_output());
}

void Tmc262::write(std::uint32_t word) {
  bool modelled = true;
  switch (tmc262::register_select_of(word)) {
    case RegisterSelect::driver_control:
      if (step_dir_off()) {
        spi_coil_currents_ = tmc262::word_in<CoilCurrents>(word);
      } else {
        driver_control_ = tmc262::word_in<DriverControl>(word);
        modelled = is_modelled(driver_control_);
      }
      break;
    case RegisterSelect::chopper_configuration:
      chopper_configuration_ = tmc262::word_in<ChopperConfiguration>(word);
      break;
    case RegisterSelect::cool_step_control:
      cool_step_control_ = tmc262::word_in<CoolStepControl>(word);
      modelled = is_modelled(cool_step_control_);
      break;
    case RegisterSelect::stall_guard_and_current:
      stall_guard_and_current_ = tmc262::word_in<StallGuardAndCurrent>(word);
      modelled = is_modelled(stall_guard_and_current_);
      break;
    case RegisterSelect::driver_configuration:
      driver_configuration_ = tmc262::word_in<DriverConfiguration>(word);
      modelled = is_modelled(driver_configuration_);
      break;
    case RegisterSelect::unassigned:
      modelled = false;
      break;
  }
  if (!modelled) {
    ++unmodelled_writes_;
    latest_unmodelled_write_ = word;
  }
}

void Tmc262::step_edge(bool rising, bool direction, std::uint64_t clock) {
  const bool active = rising || DriverControl::StepOnBothEdges::is_set(driver_control_);
  if (!active || !has_supply_ || step_dir_off()) {
    return;
  }
  latest_step_clock_ = clock;
  const std::uint32_t increment = microsteps_per_edge(driver_control_);
  const std::uint32_t before = microstep_position_;
  microstep_position_ = (before + (direction ? 0 - increment : increment)) % tmc262::microstep_positions;
  if (before / tmc262::microsteps_per_fullstep != microstep_position_ / tmc262::microsteps_per_fullstep) {
    count_full_step();
  }
}

void Tmc262::count_full_step() {
  if (!bridges_on()) {
    return;
  }
  ++unmeasured_full_steps_;
  const bool filtered = StallGuardAndCurrent::Filter::is_set(stall_guard_and_current_);
  if (unmeasured_full_steps_ >= (filtered ? full_steps_per_filtered_measurement : 1)) {
    unmeasured_full_steps_ = 0;
    stall_guard_value_ = load_measurement_;
  }
}

bool Tmc262::step_dir_off() const {
  return DriverConfiguration::StepDirOff::is_set(driver_configuration_);
}

bool Tmc262::bridges_on() const {
  return !enable_not_ && temperature_ < shutdown_temperature &&
         ChopperConfiguration::OffTime::in(chopper_configuration_) != 0;
}

Tmc262::CoilPair Tmc262::coil_currents() const {
  if (!bridges_on()) {
    return {0, 0};
  }
  if (step_dir_off()) {
    const std::int32_t a = CoilCurrents::MagnitudeA::in(spi_coil_currents_);
    const std::int32_t b = CoilCurrents::MagnitudeB::in(spi_coil_currents_);
    return {CoilCurrents::SignA::is_set(spi_coil_currents_) ? -a : a,
            CoilCurrents::SignB::is_set(spi_coil_currents_) ? -b : b};
  }
  return {sine_current(microstep_position_), sine_current(microstep_position_ + tmc262::microsteps_per_fullstep)};
}

std::int32_t Tmc262::current_scale() const {
  return StallGuardAndCurrent::CurrentScale::in(stall_guard_and_current_);
}

std::int32_t Tmc262::sense_voltage() const {
  return DriverConfiguration::LowSenseVoltage::is_set(driver_configuration_) ? low_sense_voltage : high_sense_voltage;
}

}  // namespace opentmcl::twin
