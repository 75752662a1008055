// coolStep of the TMC262: the current follows the load (datasheet chapter 6).
#pragma once

#include <cstdint>

#include "twin/chip/tmc262_register_file.hpp"

namespace opentmcl::twin {

class Tmc262CoolStep {
 public:
  /// The registers have changed.
  void apply(const Tmc262RegisterFile& registers);
  /// stallGuard2 gave `count` times the same value, 0…1023.
  void regulate(std::int32_t value, std::uint64_t count, const Tmc262RegisterFile& registers);

  /// SE: the scale in force, 0…31.
  std::int32_t scale() const { return scale_; }

  friend bool operator==(const Tmc262CoolStep&, const Tmc262CoolStep&) = default;

 private:
  std::int32_t scale_ = 0;
  std::uint64_t values_above_ = 0;  ///< in a row, since the last step down
};

}  // namespace opentmcl::twin
