#include "debug/troubles.hpp"

#include <cstdlib>

#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/io_ports.hpp"

namespace opentmcl::debug {

using client::Client;
using client::Result;

namespace {

constexpr std::uint8_t bit(Trouble trouble) {
  return static_cast<std::uint8_t>(trouble);
}

Result<bool> stalls(Client& client) {
  const Result<std::int32_t> speed = client.axis_parameter(AxisParameter::actual_speed);
  if (!speed) return speed.error();
  if (*speed == 0) return false;  // then stallGuard2 measures nothing
  const Result<std::int32_t> flags = client.axis_parameter(AxisParameter::driver_error_flags);
  if (!flags) return flags.error();
  constexpr std::int32_t stall_guard = 1;
  return (*flags & stall_guard) != 0;
}

Result<bool> deviates(Client& client) {
  const Result<std::int32_t> limit = client.axis_parameter(AxisParameter::maximum_encoder_deviation);
  if (!limit) return limit.error();
  if (*limit == 0) return false;
  const Result<std::int32_t> position = client.axis_parameter(AxisParameter::actual_position);
  if (!position) return position.error();
  const Result<std::int32_t> encoder = client.axis_parameter(AxisParameter::encoder_position);
  if (!encoder) return encoder.error();
  return std::llabs(std::int64_t{*position} - *encoder) > *limit;
}

Result<bool> lacks_supply(Client& client, const ModuleDescription& module) {
  for (const IoPortSpec& row : io_ports) {
    if (row.line != IoLine::supply_voltage || !contains(row.modules, module.id)) continue;
    const Command read{static_cast<std::uint8_t>(Opcode::gio), row.port, static_cast<std::uint8_t>(row.bank), 0};
    const Result<std::int32_t> voltage = client.execute(read);
    if (!voltage) return voltage.error();
    return *voltage < lowest_supply_voltage;
  }
  return false;
}

}  // namespace

Result<std::uint8_t> troubles_of(Client& client, const ModuleDescription& module, std::uint8_t wanted) {
  std::uint8_t found = 0;
  const auto look = [&](Trouble trouble, const auto& is_so) -> Result<void> {
    if ((wanted & bit(trouble)) == 0) return {};
    const Result<bool> so = is_so();
    if (!so) return so.error();
    if (*so) found = static_cast<std::uint8_t>(found | bit(trouble));
    return {};
  };
  if (auto done = look(Trouble::stall, [&] { return stalls(client); }); !done) return done.error();
  if (auto done = look(Trouble::deviation, [&] { return deviates(client); }); !done) return done.error();
  if (auto done = look(Trouble::under_voltage, [&] { return lacks_supply(client, module); }); !done)
    return done.error();
  return found;
}

std::string names_of_troubles(std::uint8_t troubles) {
  constexpr struct {
    Trouble trouble;
    const char* name;
  } names[] = {{Trouble::stall, "stall"}, {Trouble::deviation, "deviation"}, {Trouble::under_voltage, "under-voltage"}};
  std::string text;
  for (const auto& [trouble, name] : names) {
    if ((troubles & bit(trouble)) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text;
}

}  // namespace opentmcl::debug
