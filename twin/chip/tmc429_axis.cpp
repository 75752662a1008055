#include "twin/chip/tmc429_axis.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::AxisRegister;
using tmc429::BrakingFactor;
using tmc429::Dividers;
using tmc429::Interrupts;
using tmc429::Mode;
using tmc429::Word;

/// The field of a register that holds one number.
template <class Register>
std::int32_t value_in(std::uint32_t data) {
  return Register::Value::in(Word<Register>{data});
}

template <class Register>
std::uint32_t data_of_value(std::int32_t value) {
  return Register::Value::of(value).bits;
}

}  // namespace

std::uint32_t Tmc429Axis::writable_bits(AxisRegister index) {
  constexpr std::uint32_t any_write_arms = tmc429::LatchedPosition::Value::mask;
  constexpr std::uint32_t masks[16] = {
      tmc429::TargetPosition::Value::mask,
      tmc429::ActualPosition::Value::mask,
      tmc429::MinimumVelocity::Value::mask,
      tmc429::MaximumVelocity::Value::mask,
      tmc429::TargetVelocity::Value::mask,
      tmc429::ActualVelocity::Value::mask,
      tmc429::MaximumAcceleration::Value::mask,
      0,  // A_ACTUAL
      tmc429::CurrentScaling::AboveThreshold::mask | tmc429::CurrentScaling::BelowThreshold::mask |
          tmc429::CurrentScaling::AtRest::mask | tmc429::CurrentScaling::AccelerationThreshold::mask,
      BrakingFactor::Multiplier::mask | BrakingFactor::Divisor::mask,
      Mode::ReferenceIsRight::mask | Mode::SoftStop::mask | Mode::DisableRightStop::mask | Mode::DisableLeftStop::mask |
          Mode::Ramp::mask,
      Interrupts::Mask::mask | Interrupts::Flags::mask,
      Dividers::Pulse::mask | Dividers::Ramp::mask | Dividers::MicrostepResolution::mask,
      tmc429::ReferenceTolerance::Value::mask,
      any_write_arms,
      tmc429::MicrostepCounter::Value::mask,
  };
  return masks[static_cast<unsigned>(index)];
}

std::uint32_t Tmc429Axis::read(AxisRegister index) const {
  const Tmc429RampSettings& settings = ramp_.settings();
  switch (index) {
    case AxisRegister::target_position:
      return data_of_value<tmc429::TargetPosition>(settings.target_position);
    case AxisRegister::actual_position:
      return data_of_value<tmc429::ActualPosition>(ramp_.position());
    case AxisRegister::minimum_velocity:
      return data_of_value<tmc429::MinimumVelocity>(settings.minimum_velocity);
    case AxisRegister::maximum_velocity:
      return data_of_value<tmc429::MaximumVelocity>(settings.maximum_velocity);
    case AxisRegister::target_velocity:
      return data_of_value<tmc429::TargetVelocity>(settings.target_velocity);
    case AxisRegister::actual_velocity:
      return data_of_value<tmc429::ActualVelocity>(ramp_.velocity());
    case AxisRegister::maximum_acceleration:
      return data_of_value<tmc429::MaximumAcceleration>(settings.maximum_acceleration);
    case AxisRegister::actual_acceleration:
      return data_of_value<tmc429::ActualAcceleration>(ramp_.acceleration());
    case AxisRegister::current_scaling:
      return current_scaling_;
    case AxisRegister::braking_factor:
      return (BrakingFactor::Multiplier::of(static_cast<std::int32_t>(settings.multiplier)) |
              BrakingFactor::Divisor::of(static_cast<std::int32_t>(settings.divisor)))
          .bits;
    case AxisRegister::mode:
      return mode_.bits;
    case AxisRegister::interrupts:
      return (Interrupts::Mask::of(static_cast<std::int32_t>(mask_)) |
              Interrupts::Flags::of(static_cast<std::int32_t>(flags_)))
          .bits;
    case AxisRegister::dividers:
      return (Dividers::Pulse::of(pulse_divider_code_) | Dividers::Ramp::of(ramp_divider_code_)).bits |
             microstep_resolution_;
    case AxisRegister::reference_tolerance:
      return data_of_value<tmc429::ReferenceTolerance>(reference_tolerance_);
    case AxisRegister::latched_position:
      return latched_position_;
    case AxisRegister::microstep_counter:
      return microstep_counter_;
  }
  return 0;
}

void Tmc429Axis::write(AxisRegister index, std::uint32_t data) {
  Tmc429RampSettings settings = ramp_.settings();
  switch (index) {
    case AxisRegister::target_position:
      settings.target_position = value_in<tmc429::TargetPosition>(data);
      break;
    case AxisRegister::actual_position:
      ramp_.set_position(value_in<tmc429::ActualPosition>(data));
      break;
    case AxisRegister::minimum_velocity:
      settings.minimum_velocity = value_in<tmc429::MinimumVelocity>(data);
      break;
    case AxisRegister::maximum_velocity:
      settings.maximum_velocity = value_in<tmc429::MaximumVelocity>(data);
      break;
    case AxisRegister::target_velocity:
      settings.target_velocity = value_in<tmc429::TargetVelocity>(data);
      break;
    case AxisRegister::actual_velocity:
      ramp_.set_velocity(value_in<tmc429::ActualVelocity>(data));
      break;
    case AxisRegister::maximum_acceleration:
      settings.maximum_acceleration = value_in<tmc429::MaximumAcceleration>(data);
      break;
    case AxisRegister::actual_acceleration:
      break;  // read only
    case AxisRegister::current_scaling:
      current_scaling_ = data & writable_bits(index);
      break;
    case AxisRegister::braking_factor: {
      const Word<BrakingFactor> word = Word<BrakingFactor>{data} | BrakingFactor::fixed;
      settings.multiplier = static_cast<std::uint32_t>(BrakingFactor::Multiplier::in(word));
      settings.divisor = static_cast<std::uint32_t>(BrakingFactor::Divisor::in(word));
      break;
    }
    case AxisRegister::mode: {
      const bool armed = Mode::LatchArmed::is_set(mode_);
      mode_ = Mode::LatchArmed::replaced({data & writable_bits(index)}, armed ? 1 : 0);
      settings.mode = Mode::ramp_mode_in(mode_);
      break;
    }
    case AxisRegister::interrupts:
      write_interrupts({data});
      break;
    case AxisRegister::dividers:
      pulse_divider_code_ = Dividers::Pulse::in({data});
      ramp_divider_code_ = Dividers::Ramp::in({data});
      microstep_resolution_ = data & Dividers::MicrostepResolution::mask;
      settings.pulse_divider = tmc429_choices::divider_exponent(pulse_divider_code_);
      settings.ramp_divider = tmc429_choices::divider_exponent(ramp_divider_code_);
      break;
    case AxisRegister::reference_tolerance:
      reference_tolerance_ = value_in<tmc429::ReferenceTolerance>(data);
      break;
    case AxisRegister::latched_position:
      mode_ = mode_ | Mode::LatchArmed::set;
      break;
    case AxisRegister::microstep_counter:
      microstep_counter_ = data & writable_bits(index);
      break;
  }
  ramp_.configure(settings);
  after_change();
}

void Tmc429Axis::set_switches(bool left, bool right) {
  const bool reference_before = reference_switch();
  if (left != left_switch_) {
    raise(left ? Interrupts::LeftSwitchRises::set : Interrupts::LeftSwitchFalls::set);
  }
  if (right != right_switch_) {
    raise(right ? Interrupts::RightSwitchRises::set : Interrupts::RightSwitchFalls::set);
  }
  left_switch_ = left;
  right_switch_ = right;
  if (Mode::LatchArmed::is_set(mode_) && reference_switch() != reference_before && ramp_.moving()) {
    latched_position_ = read(AxisRegister::actual_position);
    mode_ = Mode::LatchArmed::replaced(mode_, 0);
  }
  after_change();
}

Tmc429Ramp::Steps Tmc429Axis::advance(std::uint64_t end, Tmc429Reach reach, Tmc429Ramp::Until until,
                                      std::vector<std::uint64_t>* step_ticks) {
  reach.limit_to(reach_to_consequences());
  const Tmc429Ramp::Steps steps = ramp_.advance(end, reach, until, step_ticks);
  if (steps.count != 0) {
    after_change();
  }
  return steps;
}

/// To the next step at which a condition that has a consequence begins or ends; masked interrupts have none.
Tmc429Reach Tmc429Axis::reach_to_consequences() const {
  const auto unmasked = [this](Word<Interrupts> flag) { return (mask_ & flag.bits) != 0; };
  const std::int32_t position = ramp_.position();
  Tmc429Reach reach;
  if (unmasked(Interrupts::PositionEnd::set)) {
    const std::int32_t target = ramp_.settings().target_position;
    reach.limit_to(Tmc429Reach::to_border(position, target, target));
  }
  if (unmasked(Interrupts::ReferenceMissed::set) && !reference_switch()) {
    reach.limit_to(Tmc429Reach::to_border(position, 0, 0));
  }
  const Tmc429Blocked stops = stop_switches();
  const bool tolerance_stops = reference_tolerance_ != 0 && (stops.decreasing || stops.increasing);
  if (tolerance_stops || (unmasked(Interrupts::ReferenceWrong::set) && reference_switch())) {
    reach.limit_to(Tmc429Reach::to_border(position, -reference_tolerance_, reference_tolerance_));
  }
  return reach;
}

/// The directions that would be blocked if there were no tolerance.
Tmc429Blocked Tmc429Axis::stop_switches() const {
  return {
      .decreasing = left_switch_ && !Mode::DisableLeftStop::is_set(mode_),
      .increasing = right_switch_ && !Mode::DisableRightStop::is_set(mode_),
      .soft_stop = Mode::SoftStop::is_set(mode_),
  };
}

Tmc429Blocked Tmc429Axis::blocked_directions() const {
  const bool tolerated =
      reference_tolerance_ != 0 && tmc429_choices::within_tolerance(ramp_.position(), reference_tolerance_);
  return tolerated ? Tmc429Blocked{} : stop_switches();
}

/// To be called after every step, write and switch edge: all that depends on position and switches follows.
void Tmc429Axis::after_change() {
  ramp_.block(blocked_directions());
  if (ramp_.take_stop_event()) {
    raise(Interrupts::Stop::set);
  }
  const Conditions now = conditions();
  if (now.at_target && !conditions_.at_target) {
    raise(Interrupts::PositionEnd::set);
  }
  if (now.reference_wrong && !conditions_.reference_wrong) {
    raise(Interrupts::ReferenceWrong::set);
  }
  if (now.reference_missed && !conditions_.reference_missed) {
    raise(Interrupts::ReferenceMissed::set);
  }
  conditions_ = now;
}

void Tmc429Axis::raise(Word<Interrupts> flag) {
  flags_ |= flag.bits & mask_;
}

void Tmc429Axis::write_interrupts(Word<Interrupts> word) {
  mask_ = static_cast<std::uint32_t>(Interrupts::Mask::in(word));
  flags_ &= ~static_cast<std::uint32_t>(Interrupts::Flags::in(word)) & mask_;
}

}  // namespace opentmcl::twin
