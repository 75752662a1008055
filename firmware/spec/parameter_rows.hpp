#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/modules.hpp"

namespace opentmcl {

/// The letters of the manuals' access columns (PD-1161 manual tables 15 and 17).
enum class Access : std::uint8_t {
  none = 0,
  r = 1,  ///< GAP, GGP
  w = 2,  ///< SAP, AAP, SGP, AGP
  e = 4,  ///< STAP, RSAP, STGP, RSGP; restored at power-on
  a = 8,  ///< stored at each write; restored at power-on
  rw = r | w,
  rwe = r | w | e,
  rwa = r | w | a,
};

constexpr bool allows(Access access, Access wanted) {
  return (static_cast<unsigned>(access) & static_cast<unsigned>(wanted)) != 0;
}

/// What a number means physically; the host shows and accepts physical values beside internal ones.
enum class Unit : std::uint8_t {
  none,
  microsteps,
  internal_velocity,      ///< PD-1161 manual 6.1.1
  internal_acceleration,  ///< PD-1161 manual 6.1.2
  current_scale,          ///< 255 is the full-scale current of the module, in 32 steps
  current_steps,          ///< n + 1 thirty-seconds of the full-scale current
  encoder_steps,
  milliseconds,
  ten_milliseconds,
  tenth_volts,
  degrees_celsius,
  power_of_two,
};

constexpr const char* name_of(Unit unit) {
  switch (unit) {
    case Unit::none:
      return "";
    case Unit::microsteps:
      return "microsteps";
    case Unit::internal_velocity:
      return "internal velocity";
    case Unit::internal_acceleration:
      return "internal acceleration";
    case Unit::current_scale:
      return "1/255 of full-scale current";
    case Unit::current_steps:
      return "1/32 of full-scale current";
    case Unit::encoder_steps:
      return "encoder steps";
    case Unit::milliseconds:
      return "ms";
    case Unit::ten_milliseconds:
      return "10 ms";
    case Unit::tenth_volts:
      return "0.1 V";
    case Unit::degrees_celsius:
      return "°C";
    case Unit::power_of_two:
      return "exponent of 2";
  }
  return "";
}

/// One module's column of a parameter row.
struct ParameterColumn {
  Access access;
  std::int32_t minimum;
  std::int32_t maximum;
  std::int32_t default_value;
};

/// The module lacks the parameter: reads and writes answer "wrong type".
inline constexpr ParameterColumn absent{Access::none, 0, 0, 0};

constexpr bool is_consistent(const ParameterColumn& column) {
  return column.minimum <= column.default_value && column.default_value <= column.maximum;
}

/// A row of a parameter table: the same facts for axis and global parameters.
template <class Number>
struct ParameterSpec {
  Number number;
  const char* symbol;  ///< constant in TMCLParam.tmc
  const char* name;
  Unit unit;
  ParameterColumn columns[module_count];  ///< in the order of ModuleId
  const char* description;
  const char* source;

  constexpr const ParameterColumn& in(ModuleId module) const { return columns[static_cast<std::size_t>(module)]; }
};

/// Rows sorted by number and unique, each default within its range.
template <class Number, std::size_t count>
consteval bool is_parameter_table(const ParameterSpec<Number> (&table)[count]) {
  int previous = -1;
  for (const ParameterSpec<Number>& row : table) {
    if (static_cast<int>(row.number) <= previous) return false;
    previous = static_cast<int>(row.number);
    for (const ParameterColumn& column : row.columns) {
      if (!is_consistent(column)) return false;
    }
  }
  return true;
}

inline constexpr std::int32_t int32_minimum = -2147483647 - 1;
inline constexpr std::int32_t int32_maximum = 2147483647;

}  // namespace opentmcl
