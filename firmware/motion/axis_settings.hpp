#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/lookup.hpp"

namespace opentmcl {

/// The values of one axis's parameters that are settings, by row of the axis parameter table. Parameters that are
/// measured or computed (positions, speeds, states) have a place too, so that every row has one; it is not used.
class AxisSettings {
 public:
  explicit AxisSettings(ModuleId module) {
    for (std::size_t row = 0; row < axis_parameter_count; ++row) {
      values_[row] = axis_parameter_columns[static_cast<std::size_t>(module)][row].default_value;
    }
  }

  std::int32_t operator[](AxisParameter parameter) const { return values_[row_of(parameter)]; }
  void set(AxisParameter parameter, std::int32_t value) { values_[row_of(parameter)] = value; }

  std::int32_t in_row(std::size_t row) const { return values_[row]; }
  void set_row(std::size_t row, std::int32_t value) { values_[row] = value; }

 private:
  std::int32_t values_[axis_parameter_count];
};

}  // namespace opentmcl
