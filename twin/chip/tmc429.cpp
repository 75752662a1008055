#include "twin/chip/tmc429.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace opentmcl::twin {
namespace {

using tmc429::AxisRegister;
using tmc429::CommonRegister;
using tmc429::ComparePositionInterrupt;
using tmc429::Datagram;
using tmc429::InterfaceConfiguration;
using tmc429::Reply;
using tmc429::Word;
using Until = Tmc429Ramp::Until;

constexpr std::uint32_t all_data = Datagram::Data::mask;
constexpr std::uint32_t ram_word = 0x3F3F;  // two entries of 6 bits, page 55

constexpr std::int32_t no_compared_motor = 3;

/// Bits of a common register that a write changes; 0 for read-only and unassigned ones.
constexpr std::uint32_t writable_bits(CommonRegister index) {
  using tmc429::CoverPositionAndLength;
  using tmc429::GlobalParameters;
  switch (index) {
    case CommonRegister::datagram_low_word:
    case CommonRegister::datagram_high_word:
    case CommonRegister::power_down:
      return all_data;  // a write of any value has the effect
    case CommonRegister::cover_position_and_length:
      return CoverPositionAndLength::Position::mask | CoverPositionAndLength::Length::mask;
    case CommonRegister::cover_datagram:
      return all_data;
    case CommonRegister::interface_configuration:
      return InterfaceConfiguration::EnableRightSwitches::mask | InterfaceConfiguration::ComparedMotor::mask |
             InterfaceConfiguration::EnableStepDir::mask | InterfaceConfiguration::InvertDirection::mask |
             InterfaceConfiguration::InvertStep::mask | InterfaceConfiguration::StepOnBothEdges::mask |
             InterfaceConfiguration::InterruptOutput::mask | InterfaceConfiguration::InvertSwitches::mask;
    case CommonRegister::compare_position:
      return tmc429::ComparePosition::Value::mask;
    case CommonRegister::compare_position_interrupt:
      return ComparePositionInterrupt::Enabled::mask | ComparePositionInterrupt::Occurred::mask;
    case CommonRegister::global_parameters:
      return GlobalParameters::Motor1RightIsReference3::mask | GlobalParameters::MultiplexSwitches::mask |
             GlobalParameters::ContinuousUpdate::mask | GlobalParameters::DriverClockDivider::mask |
             GlobalParameters::CommonOrIndividualSelect::mask | GlobalParameters::Polarities::mask |
             GlobalParameters::LastDriver::mask;
    case CommonRegister::type_version:
    case CommonRegister::reference_switches:
      return 0;
  }
  return 0;
}

/// Bits that are stored but whose effect this model lacks: the right switch of the 16-pin package, and the multiplexer.
constexpr std::uint32_t unmodelled_bits(CommonRegister index) {
  using tmc429::GlobalParameters;
  return index == CommonRegister::global_parameters
             ? GlobalParameters::Motor1RightIsReference3::mask | GlobalParameters::MultiplexSwitches::mask
             : 0;
}

}  // namespace

Tmc429::Tmc429(StepListener& listener)
    : outputs_{Tmc429StepOutput{0, listener}, Tmc429StepOutput{1, listener}, Tmc429StepOutput{2, listener}} {
  common(CommonRegister::global_parameters) = tmc429::GlobalParameters::reset.bits;
}

std::uint32_t Tmc429::transfer(std::uint32_t datagram) {
  powered_down_ = false;  // the falling edge of the chip select starts the clocks again
  const std::uint32_t status = status_byte();
  if (Datagram::Read::is_set({datagram})) {
    return status | read(datagram);
  }
  write(datagram);
  return status;
}

std::uint32_t Tmc429::status_byte() const {
  const Word<Reply> status = Reply::Interrupt::of(interrupt()) | Reply::AtTarget1::of(axes_[0].at_target()) |
                             Reply::AtTarget2::of(axes_[1].at_target()) | Reply::AtTarget3::of(axes_[2].at_target()) |
                             Reply::LeftSwitch1::of(axes_[0].left_switch()) |
                             Reply::LeftSwitch2::of(axes_[1].left_switch()) |
                             Reply::LeftSwitch3::of(axes_[2].left_switch());
  return status.bits;
}

std::uint32_t Tmc429::read(std::uint32_t datagram) const {
  const auto motor = static_cast<unsigned>(Datagram::Motor::in({datagram}));
  const auto index = static_cast<unsigned>(Datagram::Index::in({datagram}));
  if (Datagram::Ram::is_set({datagram})) {
    return ram_[static_cast<unsigned>(Datagram::Address::in({datagram}))];
  }
  return motor == tmc429::common_block ? read_common(index) : axes_[motor].read(static_cast<AxisRegister>(index));
}

std::uint32_t Tmc429::read_common(unsigned index) const {
  switch (static_cast<CommonRegister>(index)) {
    case CommonRegister::type_version:
      return tmc429::TypeVersion::value;
    case CommonRegister::reference_switches: {
      std::uint32_t switches = 0;
      for (unsigned motor = tmc429::motor_count; motor-- > 0;) {
        switches = (switches << 2) | (axes_[motor].left_switch() ? 2u : 0u) | (axes_[motor].right_switch() ? 1u : 0u);
      }
      return switches;
    }
    case CommonRegister::cover_position_and_length: {
      using tmc429::CoverPositionAndLength;
      const Word<CoverPositionAndLength> written{common_[index]};
      return CoverPositionAndLength::Position::replaced(written, CoverPositionAndLength::Position::in(written) + 1)
          .bits;
    }
    default:
      return common_[index];
  }
}

void Tmc429::write(std::uint32_t datagram) {
  const auto motor = static_cast<unsigned>(Datagram::Motor::in({datagram}));
  const auto index = static_cast<unsigned>(Datagram::Index::in({datagram}));
  const std::uint32_t data = tmc429::data_of(datagram);
  std::uint32_t known_bits = 0;
  if (Datagram::Ram::is_set({datagram})) {
    ram_[static_cast<unsigned>(Datagram::Address::in({datagram}))] = data & ram_word;
    known_bits = ram_word;
  } else if (motor == tmc429::common_block) {
    known_bits = write_common(index, data);
  } else {
    axes_[motor].write(static_cast<AxisRegister>(index), data);
    known_bits = Tmc429Axis::writable_bits(static_cast<AxisRegister>(index));
  }
  after_position_change();
  if ((data & ~known_bits) != 0) {
    ++unmodelled_writes_;
    latest_unmodelled_write_ = datagram;
  }
}

std::uint32_t Tmc429::write_common(unsigned index, std::uint32_t data) {
  const auto name = static_cast<CommonRegister>(index);
  const std::uint32_t writable = writable_bits(name);
  switch (name) {
    case CommonRegister::power_down:
      powered_down_ = true;
      break;
    case CommonRegister::datagram_low_word:
    case CommonRegister::datagram_high_word:
      break;  // re-arms the read-back of SPI drivers
    case CommonRegister::compare_position_interrupt: {
      const Word<ComparePositionInterrupt> written{data};
      const Word<ComparePositionInterrupt> before{common_[index]};
      const bool enabled = ComparePositionInterrupt::Enabled::is_set(written);
      const bool occurred = ComparePositionInterrupt::Occurred::is_set(before) && enabled &&
                            !ComparePositionInterrupt::Occurred::is_set(written);
      common_[index] =
          (ComparePositionInterrupt::Enabled::of(enabled) | ComparePositionInterrupt::Occurred::of(occurred)).bits;
      break;
    }
    default:
      common_[index] = data & writable;
      break;
  }
  output_settings_ = {.interface_configuration = {common(CommonRegister::interface_configuration)},
                      .global_parameters = {common(CommonRegister::global_parameters)}};
  update_switches();
  return writable & ~unmodelled_bits(name);
}

void Tmc429::set_detail(StepDetail detail) {
  if (detail == detail_) return;
  detail_ = detail;
  for (Tmc429StepOutput& output : outputs_) {
    output.set_detail(detail);
  }
}

void Tmc429::advance(std::uint64_t clocks) {
  advance_all(clocks, 0, Until::end, nullptr);
}

bool Tmc429::advance_until_change(std::uint64_t clocks, unsigned motor) {
  const std::uint64_t end = clock_ + clocks;
  advance_all(clocks, motor, axes_[motor].ramp().changing() ? Until::end : Until::velocity_changes, nullptr);
  return clock_ < end;
}

std::int32_t Tmc429::greatest_change(std::uint64_t clocks, unsigned motor) const {
  const Tmc429RampSettings& settings = axes_[motor].ramp().settings();
  const std::uint64_t ramp_ticks = ((clocks / tmc429::clock_prescaler) >> settings.ramp_divider) + 1;
  constexpr std::uint64_t from_end_to_end = std::uint64_t{2} * tmc429::MaximumVelocity::Value::maximum
                                            << tmc429::velocity_fraction_bits;
  const std::uint64_t change = ramp_ticks * static_cast<std::uint64_t>(settings.maximum_acceleration);
  return static_cast<std::int32_t>(std::min(change, from_end_to_end));
}

std::uint64_t Tmc429::clocks_for_steps(std::uint64_t steps, unsigned motor) const {
  const std::uint64_t ticks = axes_[motor].ramp().ticks_for_steps(steps);
  return ticks == std::numeric_limits<std::uint64_t>::max() ? ticks : ticks * tmc429::clock_prescaler;
}

void Tmc429::advance_listing(std::uint64_t clocks, std::vector<std::uint64_t>& step_clocks, unsigned motor) {
  // Serving SPI drivers the chip makes steps but gives none out.
  const bool step_dir = InterfaceConfiguration::EnableStepDir::is_set(output_settings_.interface_configuration);
  outputs_[motor].list_single_steps(&step_clocks);
  advance_all(clocks, motor, Until::end, step_dir ? &step_clocks : nullptr);
  outputs_[motor].list_single_steps(nullptr);
}

/// Lets time pass until `motor` has reached what it is to run to, but not more than `clocks`.
void Tmc429::advance_all(std::uint64_t clocks, unsigned motor, Until until, std::vector<std::uint64_t>* step_clocks) {
  if (powered_down_) {
    clock_ += clocks;
    stopped_clocks_ += clocks;
    return;
  }
  std::uint64_t end = clock_ + clocks;
  const bool is_even = rests(motor, tick_at(end)) || (step_clocks == nullptr && coasts(motor, tick_at(end)));
  if (!is_even) {
    end = advance_motor(motor, end, until, step_clocks);
  }
  const std::uint64_t end_tick = tick_at(end);
  for (unsigned other = 0; other < tmc429::motor_count; ++other) {
    // Most modules have one motor: the other two should cost next to nothing.
    if (other != motor && !rests(other, end_tick)) {
      advance_motor(other, end, Until::end, nullptr);
    }
  }
  clock_ = end;
}

/// Returns the clock that the motor has reached.
std::uint64_t Tmc429::advance_motor(unsigned motor, std::uint64_t end, Until until,
                                    std::vector<std::uint64_t>* step_clocks) {
  Tmc429Axis& axis = axes_[motor];
  Tmc429StepOutput& output = outputs_[motor];
  const std::int32_t velocity_before = axis.ramp().state().velocity;
  while (true) {
    // The ramp must not run past a delayed step: that may press a switch.
    const std::optional<std::uint64_t> delayed = output.delayed_edge();
    const std::uint64_t end_tick = tick_at(delayed ? std::min(end, *delayed) : end);
    if (axis.ramp().now() < end_tick) {
      const Tmc429Ramp::Steps steps = axis.advance(end_tick, reach_to_consequences(motor), until, step_clocks);
      if (steps.count != 0) {
        after_position_change();
        give_out(motor, steps, step_clocks);
      }
      if (until == Until::velocity_changes && axis.ramp().state().velocity != velocity_before) {
        end = clock_of(axis.ramp().now());
        until = Until::end;
      }
    } else if (delayed && *delayed <= end) {
      output.advance(*delayed, output_settings_);
    } else {
      break;
    }
  }
  output.flush();
  return end;
}

/// Lets time pass until `end_tick` for a motor that only gives steps at one velocity, none of which has to be looked at
/// alone. False where more may happen.
bool Tmc429::coasts(unsigned motor, std::uint64_t end_tick) {
  Tmc429Axis& axis = axes_[motor];
  Tmc429StepOutput& output = outputs_[motor];
  const bool decreasing = axis.ramp().state().velocity < 0;
  if (detail_ == StepDetail::edges || !output.immediate(decreasing) || watches_position(motor)) {
    return false;
  }
  const std::optional<Tmc429Ramp::Steps> steps = axis.coast_to(end_tick);
  if (!steps) {
    return false;
  }
  if (steps->count != 0) {
    after_position_change();
    output.steps(steps->count, clock_of(steps->first_tick), clock_of(steps->last_tick), output_settings_);
    output.flush();
  }
  return true;
}

/// Passing POS_COMP raises an interrupt.
bool Tmc429::watches_position(unsigned motor) const {
  return InterfaceConfiguration::ComparedMotor::in(output_settings_.interface_configuration) ==
             static_cast<std::int32_t>(motor) &&
         ComparePositionInterrupt::Enabled::is_set({common(CommonRegister::compare_position_interrupt)});
}

/// To the next step that must be given out alone, or that changes what the position compare shows.
Tmc429Reach Tmc429::reach_to_consequences(unsigned motor) const {
  if (detail_ == StepDetail::edges) {
    return {.decreasing = 1, .increasing = 1};
  }
  const Tmc429StepOutput& output = outputs_[motor];
  Tmc429Reach reach;
  if (!output.immediate(true)) {
    reach.decreasing = 1;
  }
  if (!output.immediate(false)) {
    reach.increasing = 1;
  }
  if (watches_position(motor)) {
    const std::int32_t position = tmc429::ActualPosition::Value::in({common(CommonRegister::compare_position)});
    reach.limit_to(Tmc429Reach::to_border(axes_[motor].position(), position, position));
  }
  return reach;
}

/// `step_clocks`, if given, ends with the ticks of these steps and is to have the clocks at which they leave the chip.
void Tmc429::give_out(unsigned motor, const Tmc429Ramp::Steps& steps, std::vector<std::uint64_t>* step_clocks) {
  Tmc429StepOutput& output = outputs_[motor];
  if (steps.count == 1) {
    if (step_clocks != nullptr) {
      step_clocks->pop_back();  // the output lists it when it gives it out
    }
    output.step(clock_of(steps.first_tick), steps.decreasing, output_settings_);
    return;
  }
  output.steps(steps.count, clock_of(steps.first_tick), clock_of(steps.last_tick), output_settings_);
  if (step_clocks != nullptr) {
    const auto first = step_clocks->end() - static_cast<std::ptrdiff_t>(steps.count);
    std::transform(first, step_clocks->end(), first, [this](std::uint64_t tick) { return clock_of(tick); });
  }
}

/// The tick of the dividers that is the latest at a clock.
std::uint64_t Tmc429::tick_at(std::uint64_t clock) const {
  return clock > stopped_clocks_ ? (clock - stopped_clocks_) / tmc429::clock_prescaler : 0;
}

std::uint64_t Tmc429::clock_of(std::uint64_t tick) const {
  return tick * tmc429::clock_prescaler + stopped_clocks_;
}

void Tmc429::set_left_switch(bool level, unsigned motor) {
  left_pins_[motor] = level;
  update_switches();
}

void Tmc429::set_right_switch(bool level, unsigned motor) {
  right_pins_[motor] = level;
  update_switches();
}

void Tmc429::update_switches() {
  const Word<InterfaceConfiguration> configuration = output_settings_.interface_configuration;
  const bool active_level = !InterfaceConfiguration::InvertSwitches::is_set(configuration);
  const bool right_enabled = InterfaceConfiguration::EnableRightSwitches::is_set(configuration);
  for (unsigned motor = 0; motor < tmc429::motor_count; ++motor) {
    axes_[motor].set_switches(left_pins_[motor] == active_level, right_enabled && right_pins_[motor] == active_level);
  }
}

bool Tmc429::position_compare_output() const {
  const auto motor = InterfaceConfiguration::ComparedMotor::in(output_settings_.interface_configuration);
  if (motor == no_compared_motor) {
    return false;
  }
  using tmc429::ActualPosition;
  const std::uint32_t position = ActualPosition::Value::of(axes_[static_cast<unsigned>(motor)].position()).bits;
  return position == common(CommonRegister::compare_position);
}

void Tmc429::after_position_change() {
  const bool matches = position_compare_output();
  std::uint32_t& interrupt_word = common(CommonRegister::compare_position_interrupt);
  if (matches && !compare_matched_ && ComparePositionInterrupt::Enabled::is_set({interrupt_word})) {
    interrupt_word |= ComparePositionInterrupt::Occurred::set.bits;
  }
  compare_matched_ = matches;
}

bool Tmc429::interrupt() const {
  for (const Tmc429Axis& axis : axes_) {
    if (axis.interrupt()) {
      return true;
    }
  }
  return ComparePositionInterrupt::Occurred::is_set({common(CommonRegister::compare_position_interrupt)});
}

bool Tmc429::step_pin(unsigned motor) const {
  return outputs_[motor].step_pin(clock_, output_settings_);
}

bool Tmc429::direction_pin(unsigned motor) const {
  return outputs_[motor].direction_pin(output_settings_);
}

}  // namespace opentmcl::twin
