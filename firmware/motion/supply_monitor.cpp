#include "firmware/motion/supply_monitor.hpp"

namespace opentmcl {

SupplyMonitor::Change SupplyMonitor::look() {
  const std::int32_t voltage = analog_.read(hal::AnalogInput::supply_voltage);
  if (is_good_ ? voltage >= lowest_supply_voltage : voltage <= release_above) return Change::none;
  is_good_ = !is_good_;
  return is_good_ ? Change::returned : Change::failed;
}

}  // namespace opentmcl
