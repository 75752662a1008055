// What the comments of a test program say: tests/programs/README.md describes the language.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/hal/time.hpp"
#include "firmware/spec/modules.hpp"

namespace opentmcl::tests {

/// A quantity of the module or of the bench, such as "variable 3" or "position".
struct Quantity {
  std::string name;
  std::optional<std::uint8_t> number;
};

/// `// at 500 ms: input 1 = high`
struct Setting {
  int line;
  Microseconds time;  ///< since the start of the program
  Quantity quantity;
  std::int32_t value;
};

/// `// expect: variable 3 = 17`
struct Expectation {
  enum class When : std::uint8_t {
    at_end,
    at,      ///< exactly at `time`
    within,  ///< at some millisecond up to `time`
  };

  int line;
  std::string text;
  Quantity quantity;
  std::int32_t value;
  std::int32_t tolerance = 0;
  When when = When::at_end;
  Microseconds time = 0;
};

struct ProgramScript {
  std::vector<ModuleId> modules;          ///< that the program is for
  std::optional<Microseconds> run_time;   ///< of a program that never ends; the others have to end
  std::vector<Setting> settings;          ///< in the order of their times
  std::vector<Expectation> expectations;  ///< in the order of the lines
  std::vector<std::string> errors;        ///< lines that look like a part of the script and are none
};

ProgramScript parse_script(std::string_view source);

}  // namespace opentmcl::tests
