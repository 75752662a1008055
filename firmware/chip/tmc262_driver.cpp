#include "firmware/chip/tmc262_driver.hpp"

namespace opentmcl {

using tmc262::DriverConfiguration;

void Tmc262Driver::send_all() {
  // The chopper last: no current flows before the rest is right.
  send(driver_configuration);
  send(stall_guard_and_current);
  send(cool_step_control);
  send(driver_control);
  send(chopper_configuration);
}

tmc262::Word<tmc262::Reply> Tmc262Driver::refresh() {
  constexpr std::uint8_t register_count = 5;
  const std::uint32_t datagrams[register_count] = {
      tmc262::datagram(driver_configuration), tmc262::datagram(stall_guard_and_current),
      tmc262::datagram(cool_step_control), tmc262::datagram(driver_control), tmc262::datagram(chopper_configuration)};
  const std::uint32_t datagram = datagrams[next_refresh_];
  next_refresh_ = static_cast<std::uint8_t>((next_refresh_ + 1) % register_count);
  return {spi_.transfer(datagram)};
}

tmc262::Word<tmc262::Reply> Tmc262Driver::reply(tmc262::ReplyFormat format) {
  if (DriverConfiguration::reply_format_in(driver_configuration) != format) {
    driver_configuration =
        DriverConfiguration::Format::replaced(driver_configuration, static_cast<std::int32_t>(format));
    send(driver_configuration);
  }
  return {spi_.transfer(tmc262::datagram(driver_control))};
}

}  // namespace opentmcl
