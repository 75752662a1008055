#pragma once

#include <cstdint>

#include "firmware/hal/analog.hpp"
#include "firmware/spec/io_ports.hpp"

namespace opentmcl {

/// Whether there is motor supply enough to move: not below lowest_supply_voltage, and when it was, not before it is
/// above `release_above` again (docs/decisions/0026-under-voltage.md).
class SupplyMonitor {
 public:
  static constexpr std::int32_t release_above = 95;  ///< 0.1 V

  enum class Change : std::uint8_t { none, failed, returned };

  explicit SupplyMonitor(hal::Analog& analog) : analog_(analog) {}

  Change look();

 private:
  hal::Analog& analog_;
  bool is_good_ = true;
};

}  // namespace opentmcl
