// A reference search on a machine with switches at random places, and where its zero belongs.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "firmware/spec/modules.hpp"
#include "twin/physics/machine.hpp"
#include "twin/physics/motor_data.hpp"

namespace opentmcl::tests {

inline constexpr double microsteps_per_full_step = 256.0;  ///< microsteps
/// Microsteps of 1/256 full step that a velocity of 1 makes in a millisecond: 16·10⁶ / (2^2 × 2048 × 32) steps a second
/// (PD-1161 manual 6.1.1), each of them 16.
inline constexpr double microsteps_per_millisecond = 16e6 / (4.0 * 2048.0 * 32.0) / 1000.0 * 16.0;

/// The same numbers in every run and with every library: std::mt19937 is standardized, its distributions are not.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}

  std::int32_t between(std::int32_t lowest, std::int32_t highest) {
    const auto count = static_cast<std::uint32_t>(highest - lowest + 1);
    return lowest + static_cast<std::int32_t>(engine_() % count);
  }
  bool one_in(std::int32_t count) { return between(1, count) == 1; }

 private:
  std::mt19937 engine_;
};

enum class Kind : std::uint8_t { linear_stage, circular_axis };

struct Search {
  ModuleId module;
  Kind kind;
  std::int32_t setting;  ///< parameter 193

  int mode() const { return setting & 15; }
  bool right_switch() const { return (setting & 64) != 0; }
  /// Option +128: the home switch is active at low level, so its contact is normally open.
  bool home_is_low_active() const { return (setting & 128) != 0; }
  bool uses_home_switch() const { return mode() >= 5; }
  /// Modes 1 and 2 measure one edge from both directions, the others both edges on one way.
  bool crosses_the_switch() const { return mode() >= 3; }
  /// Direction of the motor in which the switch is approached.
  int forth() const { return right_switch() || mode() == 6 || mode() == 8 ? 1 : -1; }
};

/// Where a switch is pressed, and what shifts its switching points; in units of place.
struct Switch {
  double from;
  double to;
  double hysteresis;
};

/// A machine with one search in it.
struct Trial {
  twin::MachineDimensions machine;
  Switch searched{};
  double start = 0;
  double backlash = 0;
  double microsteps_per_unit = 1;  ///< of place
  double period = 0;               ///< of the switch, in units of place
  int direction = 1;               ///< of the place while the position rises
  bool reversed = false;           ///< global parameter 90
  bool normally_open = false;      ///< limit switches
  std::int32_t fast = 0;
  std::int32_t slowly = 0;
  std::int32_t acceleration = 0;
  /// Nothing: an ideal one, whose rotor is always where the field is.
  std::optional<twin::MotorData> motor = {};
  double load = 0;  ///< of the machine: N on a stage, N m at a table
};

std::ostream& operator<<(std::ostream& out, const Trial& trial);

/// Every mode and option on every machine on which it makes sense.
std::vector<Search> all_searches();

/// For the names of parameterised tests.
std::string name_of(const testing::TestParamInfo<Search>& tested);

/// Dice for the trials of this search.
Dice dice_for(const Search& search);

/// A random machine for this search, with an ideal motor.
Trial random_trial(const Search& search, Dice& dice);

/// Carries the search out; fails the test when it does not end.
/// @return how far the zero is from where it should be, in microsteps
double error_of_zero(const Search& search, const Trial& trial);

}  // namespace opentmcl::tests
