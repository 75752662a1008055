#pragma once

#include <cstdint>

#include "firmware/hal/analog.hpp"

namespace opentmcl {

/// Whether there is motor supply enough to move. Source: PD-1161 manual, firmware history V1.35;
/// docs/decisions/0026-under-voltage.md.
class SupplyMonitor {
 public:
  static constexpr std::int32_t stop_below = 85;     ///< 0.1 V
  static constexpr std::int32_t release_above = 95;  ///< 0.1 V

  enum class Change : std::uint8_t { none, failed, returned };

  explicit SupplyMonitor(hal::Analog& analog) : analog_(analog) {}

  Change look();

 private:
  hal::Analog& analog_;
  bool is_good_ = true;
};

}  // namespace opentmcl
