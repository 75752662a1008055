// A module whose page writes are recorded, and every EEPROM that a power cut during them can leave behind.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"
#include "tests/module/bench.hpp"

namespace opentmcl::tests {

using Image = twin::Eeprom::Image;

/// The EEPROM as it leaves its factory.
Image erased_image();

/// A write as the EEPROM got it: bytes of one page, in the order in which they reach the cells.
struct PageWrite {
  std::uint16_t address;
  std::vector<std::uint8_t> bytes;
};

constexpr Command command(Opcode opcode, unsigned type = 0, unsigned motor_or_bank = 0, std::int32_t value = 0) {
  return {static_cast<std::uint8_t>(opcode), static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(motor_or_bank),
          value};
}

/// A module that was powered on with a given EEPROM.
class RecordedModule final : private twin::TraceObserver {
 public:
  RecordedModule(const ModuleDescription& description, const Image& eeprom);

  /// Sends one command over USB. @return its reply, or nothing when none came within two seconds
  std::optional<Datagram> exchange(const Command& command);
  /// Expects an answer that is not an error. @return the value in it
  std::int32_t execute(const Command& command);
  /// Lets time pass until nothing was written for 20 ms and the module is not about to restart.
  void settle();

  /// Lets `duration` pass.
  void wait(Microseconds duration);

  Image image() const { return module_.world().eeprom().image(); }
  const std::vector<PageWrite>& writes() const { return writes_; }
  VirtualModule& module() { return module_; }

 private:
  void changed(twin::Tick tick, std::string_view signal, std::int64_t value) override;
  void take_turns_until(Microseconds time);

  TestPort port_;
  VirtualModule module_;
  std::uint64_t bytes_written_ = 0;
  std::uint16_t address_ = 0;  ///< of the latest page write
  std::vector<PageWrite> writes_;
};

/// Calls `check` with the image that is left when the power fails after each single byte of the writes, from none to
/// all of them. @return how many cut points there were
std::size_t at_every_cut(const Image& before, const std::vector<PageWrite>& writes,
                         const std::function<void(const Image&)>& check);

}  // namespace opentmcl::tests
