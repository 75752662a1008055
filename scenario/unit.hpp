// Numbers with units, as in "24 V" or "0.8 Nm".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scenario/text_error.hpp"

namespace opentmcl::scenario {

/// What can be converted into each other.
enum class Dimension : std::uint8_t {
  time,
  length,
  angle,
  frequency,
  voltage,
  current,
  resistance,
  inductance,
  temperature,
  force,
  torque,
  mass,
  inertia,
  stiffness,
  torsional_stiffness,
  torsional_damping,
  rotation_speed,
  share,
};

struct Unit {
  std::string_view name;
  Dimension dimension;
  /// 1 of this is `numerator` / `denominator` of the dimension's first unit; two numbers, so that 18500 mV are exactly
  /// 18.5 V.
  double numerator;
  double denominator;
};

/// Those of one dimension next to each other, the usual one first.
std::span<const Unit> units();
/// nullptr for something else, also for the empty name.
const Unit* find_unit(std::string_view name);

struct NumberWithUnit {
  double value;        ///< in the unit that was asked for
  std::size_t length;  ///< bytes of the text that were used
};

/// Reads a number from the beginning of `text`, and a unit behind it if there is one; without, the number is in `unit`.
/// @param unit the name of a unit, or empty for a plain number
Parsed<NumberWithUnit> take_number(std::string_view text, std::string_view unit);

/// The same for a text that must hold nothing else.
Parsed<double> parse_number(std::string_view text, std::string_view unit);

/// "a voltage, such as 24 V", or "a number" for no unit: what a message says was expected.
std::string expected_number(std::string_view unit);

}  // namespace opentmcl::scenario
