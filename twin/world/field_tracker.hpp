// Between chips and motor: where the field of the coils is, and how it moves.
#pragma once

#include <cstdint>
#include <vector>

#include "twin/chip/step_signal.hpp"
#include "twin/chip/tmc262.hpp"
#include "twin/chip/tmc429.hpp"
#include "twin/physics/motor_shaft.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl::twin {

/// The motor asks for the field as a smooth motion over a span of time; the chips know single steps. Time is cut into
/// spans by the world; within one, everything but the position of the field is as it was when the span began.
class FieldTracker {
 public:
  /// The coils' currents and the step size as the chips have them now.
  struct Drive {
    double amplitude = 0;                 ///< A, peak
    bool energised = false;               ///< some bridge is on
    bool coil_a_connected = true;         ///< that of the sine of MSTEP
    bool coil_b_connected = true;         ///< that of its cosine
    double microsteps_a_step = 1;         ///< of 1/256 full step, for a step of the motion controller upwards
    double other_steps_per_second = 0;    ///< from the step/direction connector
    double microsteps_an_other_step = 1;  ///< of 1/256 full step
    bool is_coarse = false;               ///< single steps are to be told to the motor

    friend bool operator==(const Drive&, const Drive&) = default;
  };

  /// Where the field is, in microsteps of 1/256 full step. Counts on over turns.
  std::int64_t position() const { return position_; }

  /// The driver's sequencer has moved on by so many microsteps, the last of them at `tick`.
  void move(std::int64_t microsteps, Tick tick);
  /// The driver's sequencer stands elsewhere, as after a reset: the field jumps there by the shortest way.
  void jump_to(std::uint32_t microstep_position, Tick tick);

  /// A span begins. @param part_of_other_step StepInput::part_of_step()
  void begin(Tick now, const Drive& drive, const Tmc429::Motion& motion, double part_of_other_step);
  Tick begun() const { return begun_; }
  const Drive& drive() const { return drive_; }

  /// Turns a second of the field when the motion controller has this velocity, in 1/256 of the unit of V_ACTUAL.
  double velocity_of(std::int32_t velocity_with_fraction, unsigned pulse_divider) const;

  /// The field over the present span up to `now`. Valid until the next call of anything that is not const.
  Field until(Tick now, const Tmc429::Motion& motion) const;

 private:
  /// How fast the motion controller makes the field turn. Most motions are even and ask for one value again and again.
  struct Speed {
    std::int32_t velocity_with_fraction = 0;
    unsigned pulse_divider = 0;
    double microsteps_a_step = 0;
    double turns_per_second = 0;

    bool is_of(const Tmc429::Motion& motion, double microsteps) const {
      return velocity_with_fraction == motion.velocity_with_fraction && pulse_divider == motion.pulse_divider &&
             microsteps_a_step == microsteps;
    }
  };
  Speed speed_of(const Tmc429::Motion& motion) const;
  double other_velocity() const;

  std::int64_t position_ = 0;
  Tick begun_ = 0;
  Drive drive_;
  double start_angle_ = 0;  ///< electrical turns
  Speed start_speed_;
  std::int64_t start_position_ = 0;
  std::vector<Field::Step> steps_;
};

}  // namespace opentmcl::twin
