#include "server/module_setup.hpp"

#include <algorithm>
#include <iterator>

#include "client/client.hpp"
#include "client/program_transfer.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "server/kept_eeprom.hpp"
#include "server/simulated_transport.hpp"

namespace opentmcl::server {

using client::Client;
using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

constexpr const char* module_name = "the virtual module";

/// A module that starts in ASCII mode (global parameter 67) is put into binary mode.
Result<void> speak_binary(Simulated& simulated, MemoryLine& line, SimulatedTransport& transport) {
  simulated.wake();
  simulated.advance_to(simulated.now());
  if (!line.port().is_in_text_mode()) return {};
  constexpr std::uint8_t leave_ascii_mode[] = {'A', 'B', 'I', 'N', '\r'};
  if (Result<void> sent = transport.send(leave_ascii_mode); !sent) return sent;
  simulated.wake();
  simulated.advance_to(simulated.now() + one_millisecond);
  transport.drain();
  return {};
}

/// Where `rate` stands in a table of rates. Error: internal, for whoever let the user choose should have checked.
template <std::size_t count>
Result<std::int32_t> code_of(const std::uint32_t (&rates)[count], std::uint32_t rate) {
  const auto found = std::find(std::begin(rates), std::end(rates), rate);
  if (found != std::end(rates)) return static_cast<std::int32_t>(found - std::begin(rates));
  return Error{ErrorKind::internal, "no module knows the rate " + std::to_string(rate), {}};
}

/// @return whether it had another value
Result<bool> change(Client& client, GlobalParameter parameter, std::int32_t value) {
  const auto number = static_cast<std::uint8_t>(parameter);
  const Result<std::int32_t> present = client.global_parameter(number, Bank::module_settings);
  if (!present) return present.error();
  if (*present == value) return false;
  const Result<void> set = client.set_global_parameter(number, Bank::module_settings, value);
  if (!set) return set.error();
  return true;
}

}  // namespace

Result<void> load_program(Simulated& simulated, MemoryLine& line, const ModuleDescription& module,
                          const std::vector<Command>& commands, bool start) {
  SimulatedTransport transport(simulated, line, module_name);
  if (Result<void> binary = speak_binary(simulated, line, transport); !binary) return binary;
  Client client(transport);
  const auto keep_going = [](std::size_t, std::size_t) { return true; };
  const std::vector<Command> image = client::with_end_mark(commands, module.program_capacity);
  if (Result<void> loaded = client::download(client, image, 0, keep_going); !loaded) return loaded;
  return start ? client.start_program() : Result<void>();
}

Result<void> set_up(Simulated& simulated, VirtualModule& module, MemoryLine& line, const BusSettings& settings) {
  SimulatedTransport transport(simulated, line, module_name);
  if (Result<void> binary = speak_binary(simulated, line, transport); !binary) return binary;
  Client client(transport);
  bool has_changed = false;
  const auto set = [&](GlobalParameter parameter, std::int32_t value) -> Result<void> {
    const Result<bool> changed = change(client, parameter, value);
    if (!changed) return changed.error();
    has_changed = has_changed || *changed;
    return {};
  };
  if (settings.serial_address) {
    if (auto done = set(GlobalParameter::serial_address, *settings.serial_address); !done) return done;
  }
  if (settings.can_id) {
    if (auto done = set(GlobalParameter::can_id, *settings.can_id); !done) return done;
  }
  if (settings.rs485_baud_rate) {
    const Result<std::int32_t> code = code_of(rs485_baud_rates, *settings.rs485_baud_rate);
    if (!code) return code.error();
    if (auto done = set(GlobalParameter::rs485_baud_rate, *code); !done) return done;
  }
  if (settings.can_bit_rate) {
    const Result<std::int32_t> code = code_of(can_bit_rates, *settings.can_bit_rate);
    if (!code) return code.error();
    if (auto done = set(GlobalParameter::can_bit_rate, *code); !done) return done;
  }
  if (!has_changed) return {};
  let_eeprom_rest(simulated, module);
  module.power_cycle();
  simulated.wake();
  simulated.advance_to(simulated.now() + one_millisecond);
  return {};
}

}  // namespace opentmcl::server
