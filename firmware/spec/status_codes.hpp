// What the third byte of a reply can say. Source: PD-1161 manual 3.2.1; 7, 8 and 9 stand in no manual, only in a header
// of the vendor: they are used for what their names say.
#pragma once

#include <cstdint>

namespace opentmcl {

enum class Status : std::uint8_t {
  wrong_checksum = 1,
  invalid_command = 2,
  wrong_type = 3,
  invalid_value = 4,
  eeprom_locked = 5,
  command_not_available = 6,
  eeprom_store_failed = 7,
  eeprom_write_protected = 8,
  program_memory_full = 9,
  ok = 100,
  command_loaded = 101,
  position_reached = 128,
};

struct StatusSpec {
  Status code;
  const char* name;
  const char* description;
  const char* source;
};

inline constexpr StatusSpec status_codes[] = {
    {Status::wrong_checksum, "wrong checksum", "The ninth byte is not the sum of the first eight.", "manual 3.2.1"},
    {Status::invalid_command, "invalid command", "The module has no instruction with this number.", "manual 3.2.1"},
    {Status::wrong_type, "wrong type", "The type byte names nothing, or nothing that allows this access.",
     "manual 3.2.1"},
    {Status::invalid_value, "invalid value", "The value, the motor or the bank is out of range.", "manual 3.2.1"},
    {Status::eeprom_locked, "configuration EEPROM locked", "Global parameter 73 protects the settings.",
     "manual 3.2.1"},
    {Status::command_not_available, "command not available", "The command cannot be used in the present state.",
     "manual 3.2.1"},
    {Status::eeprom_store_failed, "storing to EEPROM failed", "A TMCL instruction could not be written.",
     "vendor header"},
    {Status::eeprom_write_protected, "EEPROM write protected", "Global parameter 81 protects the program.",
     "vendor header"},
    {Status::program_memory_full, "program memory full", "The download went past the last program address.",
     "vendor header"},
    {Status::ok, "ok", "Executed without error.", "manual 3.2.1"},
    {Status::command_loaded, "command loaded", "The instruction was stored in the program memory.", "manual 3.2.1"},
    {Status::position_reached, "position reached", "Second reply of command 138.", "manual 3.7.52"},
};

}  // namespace opentmcl
