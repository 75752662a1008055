#include "firmware/motion/axis.hpp"

#include "firmware/chip/braking_factor.hpp"
#include "firmware/motion/wrapping.hpp"

namespace opentmcl {

using tmc429::InterfaceConfiguration;
using tmc429::RampMode;

namespace {

/// How far ahead of the motor the chip's target is put on a long move. Half of what the 24-bit difference allows
/// (TMC429 application note on position ranges: 2^22), and far more than the longest braking distance of 2^19.
constexpr std::int32_t reach = 1 << 22;

/// When this little of the reach is left the chip's target moves on: 4 s at the highest step rate of 500 kHz.
constexpr std::int32_t renewal_distance = 1 << 21;

/// From a motion command to the first look at what came of it.
constexpr Microseconds first_look = one_millisecond;

}  // namespace

Axis::Axis(ModuleId module, const Hal& hal)
    : settings_(module),
      tmc429_(hal.tmc429),
      pins_(hal.pins),
      power_stage_(module, settings_, hal.tmc262),
      encoder_(module, settings_, hal.encoder),
      guard_(settings_, encoder_) {}

void Axis::initialise(const Wiring& wiring) {
  position_ = target_position_ = 0;
  bring_up(wiring);
  encoder_.initialise();
}

void Axis::bring_up(const Wiring& wiring) {
  apply(wiring);
  // After a restart of the microcontroller alone the chip may still be driving the motor: stop at once. In velocity
  // mode the position can be written without starting a move.
  tmc429_.write(tmc429::Mode::of(RampMode::velocity));
  tmc429_.write(tmc429::TargetVelocity::Value::of(0));
  tmc429_.write(tmc429::ActualVelocity::Value::of(0));
  tmc429_.write(tmc429::ActualPosition::Value::of(position_));
  tmc429_.write(tmc429::TargetPosition::Value::of(position_));
  apply(AxisParameter::minimum_speed);
  apply(AxisParameter::ramp_divisor);
  apply(AxisParameter::reference_switch_tolerance);
  apply(AxisParameter::ramp_mode);
  power_stage_.initialise();
}

void Axis::lock() {
  locked_ = true;
  position();
  if (is_positioning() && position_ != target_position_) note(AxisEvent::position_error);
  stop_at_once();
}

void Axis::unlock(const Wiring& wiring) {
  locked_ = false;
  settings_.set(AxisParameter::ramp_mode, static_cast<std::int32_t>(RampMode::velocity));
  bring_up(wiring);
}

void Axis::apply(const Wiring& wiring) {
  tmc429_.write(InterfaceConfiguration::EnableStepDir::set | InterfaceConfiguration::EnableRightSwitches::set |
                InterfaceConfiguration::InterruptOutput::set |
                InterfaceConfiguration::InvertDirection::of(wiring.reverse_shaft ? 1 : 0) |
                InterfaceConfiguration::InvertSwitches::of(wiring.switches_active_low ? 1 : 0));
  tmc429_.write(tmc429::GlobalParameters::StepPulseLength::of(wiring.step_pulse_length));
  encoder_.set_reversed(wiring.reverse_shaft);
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
    case AxisParameter::encoder_prescaler:
      encoder_.apply_prescaler();
      break;
    case AxisParameter::freewheeling_delay:
    case AxisParameter::power_down_delay:
    case AxisParameter::step_direction_mode:
      look_again();
      break;
    default:
      power_stage_.apply(parameter);
      break;
  }
}

bool Axis::is_positioning() const {
  return settings_[AxisParameter::ramp_mode] != static_cast<std::int32_t>(RampMode::velocity);
}

void Axis::write_mode() {
  const bool left_off = !limit_stops_enabled_ || settings_[AxisParameter::left_limit_switch_disable] != 0;
  const bool right_off = !limit_stops_enabled_ || settings_[AxisParameter::right_limit_switch_disable] != 0;
  // In hold mode nothing but a written velocity moves the motor.
  const std::int32_t mode = locked_ ? static_cast<std::int32_t>(RampMode::hold) : settings_[AxisParameter::ramp_mode];
  tmc429_.write(tmc429::Mode::Ramp::of(mode) | tmc429::Mode::DisableLeftStop::of(left_off ? 1 : 0) |
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

/// The target itself when the chip can reach it, else a point `reach` ahead that lead_target() moves on long
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
  error_flags_ = 0;
  settings_.set(AxisParameter::ramp_mode, static_cast<std::int32_t>(RampMode::velocity));
  wake();
  // Mode first: in ramp mode the chip would overwrite the target velocity, and a raised limit would accelerate.
  write_mode();
  tmc429_.write(tmc429::MaximumVelocity::Value::of(tmc429::MaximumVelocity::Value::maximum));
  tmc429_.write(tmc429::TargetVelocity::Value::of(velocity));
}

void Axis::move_to(std::int32_t position) {
  error_flags_ = 0;
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

std::int32_t Axis::take_error_flags() {
  const std::uint8_t flags = error_flags_;
  error_flags_ = 0;
  return flags;
}

std::uint8_t Axis::take_events() {
  const std::uint8_t events = events_;
  events_ = 0;
  return events;
}

/// A hard stop: no ramp. Velocity mode, so that nothing drives on to a target.
void Axis::stop_at_once() {
  settings_.set(AxisParameter::ramp_mode, static_cast<std::int32_t>(RampMode::velocity));
  write_mode();
  tmc429_.write(tmc429::TargetVelocity::Value::of(0));
  tmc429_.write(tmc429::ActualVelocity::Value::of(0));
}

/// @param event stall or deviation
void Axis::stop_because_of(AxisEvent event) {
  if (is_positioning()) note(AxisEvent::position_error);
  stop_at_once();
  note(event);
  error_flags_ |= static_cast<std::uint8_t>(event);
}

/// Rest means that neither the actual nor the target velocity is other than zero: at the very start of a ramp the first
/// of them still reads 0.
RampState Axis::ramp_state() {
  RampState ramp;
  ramp.velocity = actual_velocity();
  ramp.target_velocity = target_velocity();
  const std::int32_t position = this->position();
  const bool is_on_its_way = is_positioning() && position != chip_target_;
  ramp.at_rest = locked_ || (ramp.velocity == 0 && ramp.target_velocity == 0 && !is_on_its_way);
  if (ramp.velocity == 0) guard_.note_standstill(position);
  ramp.held_by_switch = !ramp.at_rest && ramp.velocity == 0 && is_held_by_switch(ramp.target_velocity);
  return ramp;
}

bool Axis::is_held_by_switch(std::int32_t target_velocity) {
  if (!limit_stops_enabled_) return false;
  const std::int32_t tolerance = settings_[AxisParameter::reference_switch_tolerance];
  if (tolerance != 0 && position_ >= -tolerance && position_ <= tolerance) return false;
  const std::int32_t direction = is_positioning() ? wrapping_difference(chip_target_, position_) : target_velocity;
  return direction < 0 ? settings_[AxisParameter::left_limit_switch_disable] == 0 && left_switch_active()
                       : settings_[AxisParameter::right_limit_switch_disable] == 0 && right_switch_active();
}

void Axis::poll(Microseconds now) {
  if (awake_) {
    awake_ = false;
    is_held_ = driver_is_shut_down_ = false;
    power_stage_.energise();
    // The chips have their commands; what comes of them is seen a little later. Commands that come all the time do not
    // put the look off.
    if (next_look_ > now + first_look) next_look_ = now + first_look;
    if (!is_look_due(now)) return;
  }
  const std::uint32_t inputs = pins_.inputs();
  RampState ramp = ramp_state();
  if (!ramp.at_rest) {
    lead_target();
    note_obstacles(ramp);
    if (guard(ramp, inputs)) ramp = ramp_state();
  }
  next_look_ = power_stage_.follow(ramp, is_high(inputs, hal::InputPin::step_dir_enable), now);
  if (!ramp.at_rest) next_look_ = now + guard_.period();
}

/// Long before the chip would brake for a target that is only a point on the way, it gets the next one.
void Axis::lead_target() {
  if (!is_positioning() || chip_target_ == target_position_) return;
  const std::int32_t ahead = wrapping_difference(chip_target_, position_);
  if (ahead < renewal_distance && ahead > -renewal_distance) write_target();
}

void Axis::note_obstacles(const RampState& ramp) {
  if (ramp.held_by_switch && !is_held_ && is_positioning()) note(AxisEvent::position_error);
  is_held_ = ramp.held_by_switch;
  const bool is_shut_down = power_stage_.is_shut_down();
  if (is_shut_down && !driver_is_shut_down_) note(AxisEvent::driver_shutdown);
  driver_is_shut_down_ = is_shut_down;
  // So often that neither a null event nor a wrap of the encoder's counter is missed.
  encoder_.follow();
}

/// @return whether it had to stop the motor
bool Axis::guard(const RampState& ramp, std::uint32_t inputs) {
  if (guard_.sees_stall(ramp, position_, is_high(inputs, hal::InputPin::stall_guard))) {
    stop_because_of(AxisEvent::stall);
  } else if (guard_.sees_deviation(position_)) {
    stop_because_of(AxisEvent::deviation);
  } else {
    return false;
  }
  return true;
}

}  // namespace opentmcl
