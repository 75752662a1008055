#include "twin/world/field_tracker.hpp"

namespace opentmcl::twin {
namespace {

constexpr double microsteps_per_electrical_turn = tmc262::microstep_positions;

constexpr double turns_of(double microsteps) {
  return microsteps / microsteps_per_electrical_turn;
}

/// How far the motion controller has come within the present step, -1/2…1/2: a field that moves in steps is, on
/// average, half a step ahead of where it last stepped to.
double part_of_step(const Tmc429::Motion& motion) {
  if (motion.velocity_with_fraction == 0) return 0;
  const double part = static_cast<double>(motion.accumulator) / tmc429::pulse_accumulator_size - 0.5;
  return motion.velocity_with_fraction < 0 ? -part : part;
}

}  // namespace

void FieldTracker::move(std::int64_t microsteps, Tick tick) {
  position_ += microsteps;
  if (drive_.is_coarse) steps_.push_back({tick, turns_of(static_cast<double>(position_))});
}

void FieldTracker::jump_to(std::uint32_t microstep_position, Tick tick) {
  constexpr std::uint32_t turn = tmc262::microstep_positions;
  const std::uint32_t ahead = (microstep_position - static_cast<std::uint32_t>(position_)) % turn;
  const std::int64_t way = ahead < turn / 2 ? std::int64_t{ahead} : std::int64_t{ahead} - std::int64_t{turn};
  if (way != 0) move(way, tick);
}

/// R = f_CLK v / (2^PULSE_DIV 2048 32) steps a second (TMC429 datasheet, page 36).
double FieldTracker::velocity_of(std::int32_t velocity_with_fraction, unsigned pulse_divider) const {
  constexpr double one = 1 << tmc429::velocity_fraction_bits;
  const double pulse_ticks_per_second =
      1 / (seconds_per_tick * tmc429::clock_prescaler * static_cast<double>(std::uint64_t{1} << pulse_divider));
  const double steps_per_second =
      pulse_ticks_per_second * velocity_with_fraction / one / tmc429::pulse_accumulator_size;
  return turns_of(steps_per_second * drive_.microsteps_a_step);
}

FieldTracker::Speed FieldTracker::speed_of(const Tmc429::Motion& motion) const {
  if (start_speed_.is_of(motion, drive_.microsteps_a_step)) return start_speed_;
  return {motion.velocity_with_fraction, motion.pulse_divider, drive_.microsteps_a_step,
          velocity_of(motion.velocity_with_fraction, motion.pulse_divider)};
}

double FieldTracker::other_velocity() const {
  return turns_of(drive_.other_steps_per_second * drive_.microsteps_an_other_step);
}

void FieldTracker::begin(Tick now, const Drive& drive, const Tmc429::Motion& motion, double part_of_other_step) {
  begun_ = now;
  drive_ = drive;
  steps_.clear();
  start_position_ = position_;
  const double within = drive.is_coarse ? 0
                                        : part_of_step(motion) * drive.microsteps_a_step +
                                              part_of_other_step * drive.microsteps_an_other_step;
  start_angle_ = turns_of(static_cast<double>(position_) + within);
  start_speed_ = speed_of(motion);
}

Field FieldTracker::until(Tick now, const Tmc429::Motion& motion) const {
  Field field{.angle = start_angle_,
              .velocity = drive_.is_coarse ? 0 : start_speed_.turns_per_second + other_velocity(),
              .acceleration = 0,
              .amplitude = drive_.amplitude,
              .energised = drive_.energised,
              // The motor's first coil is the one of the cosine.
              .coil_a_connected = drive_.coil_b_connected,
              .coil_b_connected = drive_.coil_a_connected,
              .steps = steps_};
  if (now == begun_ || drive_.is_coarse) return field;
  const double seconds = static_cast<double>(now - begun_) * seconds_per_tick;
  const double velocity = speed_of(motion).turns_per_second + other_velocity();
  if (field.velocity == 0 && velocity == 0) {
    // Steps that nobody announced are spread over the span.
    field.velocity = turns_of(static_cast<double>(position_ - start_position_)) / seconds;
  } else {
    field.acceleration = (velocity - field.velocity) / seconds;
  }
  return field;
}

}  // namespace opentmcl::twin
