// All settings as a host reads them after a restart.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/power_cut/recorded_module.hpp"

namespace opentmcl::tests {

/// One value and how to name it in a message.
struct VisibleSetting {
  Command question;
  std::int32_t value;

  bool operator==(const VisibleSetting& other) const { return value == other.value; }
};

std::string name_of(const VisibleSetting& setting);

/// Axis parameters, global parameters, user variables and coordinates in RAM, and what the EEPROM holds of the last
/// two. Values that change by themselves are left out. Equal modules give equal lists.
std::vector<VisibleSetting> visible_settings(RecordedModule& module);
std::vector<VisibleSetting> visible_settings(const ModuleDescription& description, const Image& eeprom);

/// Expects each setting to be as in `before` or as in `after`. @return whether that is so
bool are_old_or_new(const std::vector<VisibleSetting>& settings, const std::vector<VisibleSetting>& before,
                    const std::vector<VisibleSetting>& after);

/// Instructions of the program memory from address 0 on; empty while it cannot be read.
std::vector<std::array<std::uint8_t, 7>> visible_program(RecordedModule& module, unsigned count);

/// Whether global parameter 77 has started the program, as only a whole one is.
bool is_program_running(RecordedModule& module);

}  // namespace opentmcl::tests
