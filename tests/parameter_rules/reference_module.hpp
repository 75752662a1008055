// A second opinion on the rules of parameters: which exist, who may do what with them, what is kept. Written from the
// manuals, not from the firmware's tables, and without any of its code.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::tests {

/// What a module has to answer.
struct Expectation {
  bool is_answered = true;
  std::uint8_t host_address = 0;
  std::uint8_t module_address = 0;
  std::uint8_t status = 0;
  /// The value is between these two; they are equal unless it changes by itself.
  std::int32_t lowest = 0;
  std::int32_t highest = 0;
};

/// Instructions the reference knows, by their numbers in the manual.
enum ReferenceOpcode : std::uint8_t {
  ref_sap = 5,
  ref_gap = 6,
  ref_stap = 7,
  ref_rsap = 8,
  ref_sgp = 9,
  ref_ggp = 10,
  ref_stgp = 11,
  ref_rsgp = 12,
  ref_calc = 19,
  ref_sco = 30,
  ref_gco = 31,
  ref_cco = 32,
  ref_aap = 34,
  ref_agp = 35,
  ref_aco = 39,
};
inline constexpr std::uint8_t ref_calc_load = 9;

/// One module's rules for one parameter.
struct ParameterRule {
  const char* access;  ///< the manuals' letters R, W, E, A; ~ for a value that changes by itself
  std::int32_t minimum;
  std::int32_t maximum;
  std::int32_t default_value;

  bool allows(char letter) const;
};

/// @return the rule, or nullptr when the module has no such parameter
const ParameterRule* axis_parameter_rule(ModuleId module, std::uint8_t number);
const ParameterRule* global_parameter_rule(ModuleId module, std::uint8_t number);

class ReferenceModule {
 public:
  explicit ReferenceModule(ModuleId module);

  std::uint8_t address() const { return static_cast<std::uint8_t>(global(66)); }
  std::uint8_t group_address() const { return static_cast<std::uint8_t>(global(87)); }
  /// No reply is suppressed (global parameter 255).
  bool answers_everything() const { return global(255) == 0; }
  /// Command 137 would be answered with status 5.
  bool refuses_factory_reset() const { return is_locked(); }
  /// Longest time before a reply in milliseconds.
  std::int32_t telegram_pause() const { return global(75); }

  /// What the module has to answer to a request over RS485, which it carries out.
  Expectation request(std::uint8_t request_address, const Command& command);
  /// What really was answered: some values (CCO) are only known so.
  void observe(std::int32_t value);

  /// Power-on, everything stored before being in the EEPROM.
  void restart();
  /// Command 137.
  void restore_factory_settings();

 private:
  struct Result {
    std::uint8_t status;
    std::int32_t lowest;
    std::int32_t highest;
  };
  Result execute(const Command& command);
  Result axis_command(const Command& command);
  Result global_command(const Command& command);
  Result coordinate_command(const Command& command);
  std::uint8_t set_axis_parameter(std::uint8_t number, std::int32_t value);
  std::uint8_t set_global_parameter(std::uint8_t bank, std::uint8_t number, std::int32_t value);
  std::uint8_t set_coordinate(std::uint8_t number, std::int32_t value);
  std::int32_t global(std::uint8_t number) const;
  bool is_locked() const { return module_ == ModuleId::tmcm1110 && global(73) != 0; }
  void load();

  static constexpr std::size_t number_of_stored_variables = 56;
  static constexpr std::size_t number_of_coordinates = 21;

  ModuleId module_;
  std::map<std::uint8_t, std::int32_t> axis_;
  std::map<std::uint8_t, std::int32_t> global_;
  std::array<std::int32_t, 256> variables_{};
  std::map<std::uint8_t, std::int32_t> interrupts_;
  std::array<std::int32_t, number_of_coordinates> coordinates_{};
  std::int32_t accumulator_ = 0;
  std::optional<std::uint8_t> unknown_coordinate_;
  bool mode_is_known_ = false;           ///< parameter 138 was set just now
  bool prescaler_is_asked_for_ = false;  ///< by the latest command, and a null event may have changed it

  struct Eeprom {
    std::map<std::uint8_t, std::int32_t> axis;
    std::map<std::uint8_t, std::int32_t> global;
    std::array<std::int32_t, number_of_stored_variables> variables{};
    std::array<std::int32_t, number_of_coordinates> coordinates{};
  } eeprom_;
};

}  // namespace opentmcl::tests
