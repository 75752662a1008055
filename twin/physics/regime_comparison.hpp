// Random moves of random motors, each once with the regimes and once integrated throughout: how the fast way of
// computing a motor is held against the true one. Used by a test and by a program.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "twin/physics/elementary.hpp"
#include "twin/physics/motor_shaft.hpp"

namespace opentmcl::twin {

/// A motor at its rated current on 24 V is started under a load and turned on for a while.
struct ComparedMove {
  const MotorData* motor;
  Load load;
  double velocity;      ///< electrical turns per second
  double acceleration;  ///< electrical turns per second²

  static constexpr double supply = 24;
  static constexpr double cruise_seconds = 1;

  double amplitude() const { return motor->rated_amplitude(); }
};

struct MoveResult {
  std::optional<double> stall_time;  ///< s, when the rotor was a whole electrical turn behind
  double mean_lead = 0;              ///< electrical turns, over the last half second of a move without stall
  double integrated_share = 0;       ///< of the time
};

/// @param highest_rpm  speeds are spread from a tenth of it to all of it
class RandomMoves {
 public:
  RandomMoves(std::uint64_t seed, double highest_rpm) : random_(seed), highest_rpm_(highest_rpm) {}

  ComparedMove next(TorqueTables& tables) {
    ComparedMove move{};
    const auto all = motors();
    move.motor = &all[random_() % all.size()];
    constexpr double turns_per_second_and_rpm = MotorData::pole_pairs / 60;
    move.velocity = uniform(0.1, 1) * highest_rpm_ * turns_per_second_and_rpm;
    constexpr double ln20 = 2.995732273553991;
    move.acceleration = MotorData::pole_pairs * 5 *
                        exponential(uniform(0, ln20));  // 5 to 100 turns of the shaft per s², as many in each octave
    move.load.inertia = uniform(0.6, 2.3) * move.motor->rotor_inertia;
    constexpr double ambient = 25;
    const double pull_out =
        tables.table(*move.motor, TorqueTables::key(ComparedMove::supply, move.amplitude(), ambient))
            ->pull_out_torque(move.velocity);
    // Half of the loads hang on the shaft, half only rub.
    const double torque = uniform(0, 1.1) * pull_out;
    if (random_() % 2 == 0) {
      move.load.torque = torque;
    } else {
      move.load.coulomb_friction = torque;
    }
    return move;
  }

 private:
  double uniform(double lowest, double highest) {
    return lowest + (highest - lowest) * static_cast<double>(random_() >> 11U) * 0x1p-53;
  }

  std::mt19937_64 random_;
  double highest_rpm_;
};

inline MoveResult result_of(const ComparedMove& move, const std::shared_ptr<TorqueTables>& tables, bool always_free) {
  MotorShaft shaft(*move.motor, tables);
  shaft.set_supply(ComparedMove::supply);
  shaft.set_load(move.load);
  shaft.set_always_free(always_free);

  constexpr Tick grid = 320;
  const auto ticks = [](double seconds) { return static_cast<Tick>(seconds / seconds_per_tick) / grid * grid; };
  const Tick ramp_end = ticks(move.velocity / move.acceleration);
  const Tick end = ramp_end + ticks(ComparedMove::cruise_seconds);
  Field field{.acceleration = move.acceleration, .amplitude = move.amplitude(), .energised = true};
  MoveResult result;
  Tick integrated = 0;
  double lead_sum = 0;
  Tick lead_time = 0;
  while (shaft.now() < end) {
    const bool accelerating = shaft.now() < ramp_end;
    if (!accelerating) field.acceleration = 0;
    const Tick span = std::min(shaft.longest_span(field), (accelerating ? ramp_end : end) - shaft.now());
    const double seconds = static_cast<double>(span) * seconds_per_tick;
    shaft.advance_to(shaft.now() + span, field);
    field.angle = field.angle_after(seconds);
    field.velocity = field.velocity_after(seconds);

    if (shaft.regime() != Regime::locked) integrated += span;
    const double lead = field.angle - shaft.state().angle;
    if (std::fabs(lead) > 1) {
      result.stall_time = static_cast<double>(shaft.now()) * seconds_per_tick;
      break;
    }
    if (shaft.now() > end - ticks(ComparedMove::cruise_seconds / 2)) {
      lead_sum += lead * static_cast<double>(span);
      lead_time += span;
    }
  }
  if (lead_time > 0) result.mean_lead = lead_sum / static_cast<double>(lead_time);
  result.integrated_share = static_cast<double>(integrated) / static_cast<double>(shaft.now());
  return result;
}

}  // namespace opentmcl::twin
