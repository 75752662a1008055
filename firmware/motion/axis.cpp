#include "firmware/motion/axis.hpp"

#include "firmware/chip/braking_factor.hpp"
#include "firmware/motion/driver_fields.hpp"
#include "firmware/motion/wrapping.hpp"

namespace opentmcl {

using tmc262::StallGuardAndCurrent;
using tmc429::InterfaceConfiguration;
using tmc429::RampMode;

namespace {

/// How far ahead of the motor the chip's target is put on a long move. Half of what the 24-bit difference allows
/// (TMC429 application note on position ranges: 2^22), and far more than the longest braking distance of 2^19.
constexpr std::int32_t reach = 1 << 22;

/// When this little of the reach is left the chip's target moves on: 4 s at the highest step rate of 500 kHz.
constexpr std::int32_t renewal_distance = 1 << 21;

/// While the motor moves: how often the position is read. At 500 kHz the 24-bit counter wraps after 33 s.
constexpr Microseconds position_period = 250 * one_millisecond;

/// How often rest and motion are told apart, as in the vendor's firmware.
constexpr Microseconds current_period = 10 * one_millisecond;

}  // namespace

Axis::Axis(ModuleId module, hal::SpiDevice& tmc429, hal::SpiDevice& tmc262)
    : settings_(module), tmc429_(tmc429), tmc262_(tmc262) {}

void Axis::initialise(const Wiring& wiring) {
  apply(wiring);
  // After a restart of the microcontroller alone the chip may still be driving the motor: stop at once. In velocity
  // mode the position can be written without starting a move.
  tmc429_.write(tmc429::Mode::of(RampMode::velocity));
  tmc429_.write(tmc429::TargetVelocity::Value::of(0));
  tmc429_.write(tmc429::ActualVelocity::Value::of(0));
  tmc429_.write(tmc429::ActualPosition::Value::of(0));
  tmc429_.write(tmc429::TargetPosition::Value::of(0));
  position_ = target_position_ = chip_target_ = 0;
  write_mode();
  tmc429_.write(tmc429::MinimumVelocity::Value::of(settings_[AxisParameter::minimum_speed]));
  tmc429_.write(tmc429::MaximumVelocity::Value::of(settings_[AxisParameter::maximum_positioning_speed]));
  apply(AxisParameter::ramp_divisor);
  tmc429_.write(tmc429::ReferenceTolerance::Value::of(settings_[AxisParameter::reference_switch_tolerance]));
  apply_driver_settings(settings_, false, tmc262_);
  set_current(settings_[AxisParameter::maximum_current]);
  tmc262_.send_all();
  wake();
}

void Axis::apply(const Wiring& wiring) {
  tmc429_.write(InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::EnableRightSwitches::set |
                InterfaceConfiguration::InterruptOutput::set |
                InterfaceConfiguration::InvertDirection::of(wiring.reverse_shaft ? 1 : 0) |
                InterfaceConfiguration::InvertSwitches::of(wiring.switches_active_low ? 1 : 0));
  tmc429_.write(tmc429::GlobalParameters::StepPulseLength::of(wiring.step_pulse_length));
}

void Axis::apply(AxisParameter parameter) {
  switch (parameter) {
    case AxisParameter::maximum_positioning_speed:
      // In velocity mode the limit stays open; the next move_to() sets it.
      if (is_positioning()) {
        tmc429_.write(tmc429::MaximumVelocity::Value::of(settings_[AxisParameter::maximum_positioning_speed]));
      }
      break;
    case AxisParameter::minimum_speed:
      tmc429_.write(tmc429::MinimumVelocity::Value::of(settings_[AxisParameter::minimum_speed]));
      break;
    case AxisParameter::ramp_divisor:
    case AxisParameter::pulse_divisor:
      tmc429_.write(tmc429::Dividers::Pulse::of(settings_[AxisParameter::pulse_divisor]) |
                    tmc429::Dividers::Ramp::of(settings_[AxisParameter::ramp_divisor]));
      write_braking_factor();
      break;
    case AxisParameter::maximum_acceleration:
      write_braking_factor();
      break;
    case AxisParameter::ramp_mode:
      tmc429_.write(tmc429::MaximumVelocity::Value::of(is_positioning()
                                                           ? settings_[AxisParameter::maximum_positioning_speed]
                                                           : tmc429::MaximumVelocity::Value::maximum));
      write_mode();
      if (is_positioning()) write_target();
      wake();
      break;
    case AxisParameter::left_limit_switch_disable:
    case AxisParameter::right_limit_switch_disable:
    case AxisParameter::soft_stop:
      write_mode();
      break;
    case AxisParameter::reference_switch_tolerance:
      tmc429_.write(tmc429::ReferenceTolerance::Value::of(settings_[AxisParameter::reference_switch_tolerance]));
      break;
    case AxisParameter::maximum_current:
    case AxisParameter::standby_current:
      set_current(
          settings_[power_ == Power::standby ? AxisParameter::standby_current : AxisParameter::maximum_current]);
      break;
    default:
      apply_driver();
      break;
  }
}

void Axis::apply_driver() {
  const auto before = tmc262_;
  apply_driver_settings(settings_, false, tmc262_);
  if (!(tmc262_.driver_control == before.driver_control)) tmc262_.send(tmc262_.driver_control);
  if (!(tmc262_.chopper_configuration == before.chopper_configuration)) tmc262_.send(tmc262_.chopper_configuration);
  if (!(tmc262_.cool_step_control == before.cool_step_control)) tmc262_.send(tmc262_.cool_step_control);
  if (!(tmc262_.stall_guard_and_current == before.stall_guard_and_current)) {
    tmc262_.send(tmc262_.stall_guard_and_current);
  }
  if (!(tmc262_.driver_configuration == before.driver_configuration)) tmc262_.send(tmc262_.driver_configuration);
}

bool Axis::is_positioning() const {
  return settings_[AxisParameter::ramp_mode] != static_cast<std::int32_t>(RampMode::velocity);
}

void Axis::write_mode() {
  const bool left_off = !limit_stops_enabled_ || settings_[AxisParameter::left_limit_switch_disable] != 0;
  const bool right_off = !limit_stops_enabled_ || settings_[AxisParameter::right_limit_switch_disable] != 0;
  tmc429_.write(tmc429::Mode::Ramp::of(settings_[AxisParameter::ramp_mode]) |
                tmc429::Mode::DisableLeftStop::of(left_off ? 1 : 0) |
                tmc429::Mode::DisableRightStop::of(right_off ? 1 : 0) |
                tmc429::Mode::SoftStop::of(settings_[AxisParameter::soft_stop]));
}

void Axis::enable_limit_stops(bool enabled) {
  limit_stops_enabled_ = enabled;
  write_mode();
}

void Axis::write_braking_factor() {
  const std::int32_t acceleration = settings_[AxisParameter::maximum_acceleration];
  tmc429_.write(tmc429::MaximumAcceleration::Value::of(acceleration));
  tmc429_.write(tmc429::braking_pair(acceleration, settings_[AxisParameter::ramp_divisor],
                                     settings_[AxisParameter::pulse_divisor])
                    .word());
}

/// The target itself when the chip can reach it, else a point `reach` ahead that follow_position() moves on long
/// before the chip would brake for it: so a long move is one ramp.
void Axis::write_target() {
  const std::int32_t distance = wrapping_difference(target_position_, position());
  if (distance > reach) {
    chip_target_ = wrapping_sum(position_, reach);
  } else if (distance < -reach) {
    chip_target_ = wrapping_difference(position_, reach);
  } else {
    chip_target_ = target_position_;
  }
  tmc429_.write(tmc429::TargetPosition::Value::of(chip_target_));
}

void Axis::rotate(std::int32_t velocity) {
  settings_.set(AxisParameter::ramp_mode, static_cast<std::int32_t>(RampMode::velocity));
  wake();
  // Mode first: in ramp mode the chip would overwrite the target velocity, and a raised limit would accelerate.
  write_mode();
  tmc429_.write(tmc429::MaximumVelocity::Value::of(tmc429::MaximumVelocity::Value::maximum));
  tmc429_.write(tmc429::TargetVelocity::Value::of(velocity));
}

void Axis::move_to(std::int32_t position) {
  settings_.set(AxisParameter::ramp_mode, static_cast<std::int32_t>(RampMode::ramp));
  target_position_ = position;
  wake();
  tmc429_.write(tmc429::MaximumVelocity::Value::of(settings_[AxisParameter::maximum_positioning_speed]));
  write_target();
  write_mode();
}

std::int32_t Axis::position() {
  const std::int32_t counter = tmc429_.value<tmc429::ActualPosition>();
  const std::int32_t moved =
      tmc429::ActualPosition::Value::in(tmc429::ActualPosition::Value::of(wrapping_difference(counter, position_)));
  position_ = wrapping_sum(position_, moved);
  return position_;
}

void Axis::set_position(std::int32_t position) {
  position_ = position;
  tmc429_.write(tmc429::ActualPosition::Value::of(position));
  if (is_positioning()) write_target();
  wake();
}

void Axis::set_target_position(std::int32_t position) {
  target_position_ = position;
  if (is_positioning()) write_target();
  wake();
}

void Axis::set_target_velocity(std::int32_t velocity) {
  tmc429_.write(tmc429::TargetVelocity::Value::of(velocity));
  wake();
}

bool Axis::left_switch_active() {
  return tmc429::ReferenceSwitches::Left1::is_set(tmc429_.read<tmc429::ReferenceSwitches>());
}

bool Axis::right_switch_active() {
  return tmc429::ReferenceSwitches::Right1::is_set(tmc429_.read<tmc429::ReferenceSwitches>());
}

std::int32_t Axis::load_value() {
  return tmc262::Reply::StallGuardValue::in(tmc262_.reply(tmc262::ReplyFormat::stall_guard));
}

std::int32_t Axis::actual_current_scale() {
  return tmc262::Reply::CurrentScale::in(tmc262_.reply(tmc262::ReplyFormat::stall_guard_and_current));
}

std::int32_t Axis::driver_flags() {
  return tmc262::Reply::Flags::in(tmc262_.reply(tmc262::ReplyFormat::stall_guard));
}

void Axis::set_current(std::int32_t current) {
  tmc262_.stall_guard_and_current =
      StallGuardAndCurrent::CurrentScale::replaced(tmc262_.stall_guard_and_current, current_scale_of(current));
  tmc262_.send(tmc262_.stall_guard_and_current);
}

void Axis::wake() {
  awake_ = true;
}

Microseconds Axis::follow_motion(Microseconds now) {
  if (awake_) {
    awake_ = false;
    if (power_ == Power::standby) set_current(settings_[AxisParameter::maximum_current]);
    power_ = Power::run;
  }
  const Microseconds position_due = follow_position(now);
  const Microseconds current_due = follow_current(now);
  next_check_ = position_due < current_due ? position_due : current_due;
  return next_check_;
}

Microseconds Axis::follow_position(Microseconds now) {
  if (power_ == Power::standby) return never;
  const std::int32_t position = this->position();
  if (is_positioning() && chip_target_ != target_position_) {
    const std::int32_t ahead = wrapping_difference(chip_target_, position);
    if (ahead < renewal_distance && ahead > -renewal_distance) write_target();
  }
  return now + position_period;
}

/// Standby current after the power down delay (parameter 214) at rest. Rest means that neither the actual nor the
/// target velocity is other than zero: at the very start of a ramp the first of them still reads 0.
Microseconds Axis::follow_current(Microseconds now) {
  if (power_ == Power::standby) return never;
  if (actual_velocity() != 0 || target_velocity() != 0 || (is_positioning() && position_ != chip_target_)) {
    power_ = Power::run;
    return now + current_period;
  }
  if (power_ == Power::run) {
    power_ = Power::settling;
    at_rest_since_ = now;
  }
  const Microseconds delay =
      static_cast<Microseconds>(settings_[AxisParameter::power_down_delay]) * 10 * one_millisecond;
  if (now - at_rest_since_ < delay) {
    const Microseconds due = at_rest_since_ + delay;
    const Microseconds next = now + current_period;
    return due < next ? due : next;
  }
  power_ = Power::standby;
  set_current(settings_[AxisParameter::standby_current]);
  return never;
}

}  // namespace opentmcl
