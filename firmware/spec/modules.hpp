// The two modules OpenTMCL implements. Everything that differs between them is a column of a table or a field here.
#pragma once

#include <cstddef>
#include <cstdint>

namespace opentmcl {

enum class ModuleId : std::uint8_t { tmcm1110, pd1161 };

inline constexpr std::size_t module_count = 2;

/// A set of modules: in which of them a row of a table exists.
enum class Modules : std::uint8_t { none = 0, tmcm1110 = 1, pd1161 = 2, both = 3 };

constexpr bool contains(Modules set, ModuleId module) {
  return (static_cast<unsigned>(set) >> static_cast<unsigned>(module) & 1U) != 0;
}

struct ModuleDescription {
  ModuleId id;
  const char* name;             ///< as printed on the manual: "PD-1161"
  const char* argument;         ///< as typed on a command line: "pd1161"
  std::uint16_t type_number;    ///< what command 136 answers: 1110 or 1161
  std::uint8_t firmware_major;  ///< version of the firmware whose behaviour is implemented
  std::uint8_t firmware_minor;
  std::uint8_t axis_count;           ///< motors that commands accept; decision 0003 for the TMCM-1110
  std::uint16_t program_capacity;    ///< TMCL instructions
  std::uint16_t full_scale_current;  ///< mA RMS at a current parameter of 255
};

inline constexpr ModuleDescription modules[module_count] = {
    {ModuleId::tmcm1110, "TMCM-1110", "tmcm1110", 1110, 1, 8, 1, 2048, 2800},
    {ModuleId::pd1161, "PD-1161", "pd1161", 1161, 1, 47, 1, 2048, 2800},
};

inline constexpr const ModuleDescription& tmcm1110 = modules[static_cast<std::size_t>(ModuleId::tmcm1110)];
inline constexpr const ModuleDescription& pd1161 = modules[static_cast<std::size_t>(ModuleId::pd1161)];

static_assert(tmcm1110.id == ModuleId::tmcm1110 && pd1161.id == ModuleId::pd1161);

}  // namespace opentmcl
