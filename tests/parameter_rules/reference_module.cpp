#include "tests/parameter_rules/reference_module.hpp"

#include <cstring>
#include <limits>

namespace opentmcl::tests {

namespace {

constexpr std::int32_t lowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t highest = std::numeric_limits<std::int32_t>::max();

// Status codes, PD-1161 manual 3.2.1.
constexpr std::uint8_t ok = 100;
constexpr std::uint8_t invalid_command = 2;
constexpr std::uint8_t wrong_type = 3;
constexpr std::uint8_t invalid_value = 4;
constexpr std::uint8_t eeprom_locked = 5;

struct Row {
  std::uint8_t number;
  ParameterRule rules[2];  // TMCM-1110, PD-1161
};

constexpr ParameterRule missing{"", 0, 0, 0};

constexpr Row both(std::uint8_t number, ParameterRule rule) {
  return {number, {rule, rule}};
}

// PD-1161 manual chapter 4; for the TMCM-1110 the table of its V1.03 manual with what later firmware added. Defaults
// and what the TMCM-1110 can store: docs/decisions/0004 and 0016.
// clang-format off
constexpr Row axis_rows[] = {
    both(0, {"RW~", lowest, highest, 0}),  both(1, {"RW~", lowest, highest, 0}),
    both(2, {"RW~", -2047, 2047, 0}),      both(3, {"R~", -2047, 2047, 0}),
    both(4, {"RWE", 1, 2047, 1000}),       both(5, {"RWE", 1, 2047, 1000}),
    both(6, {"RWE", 0, 255, 128}),         {7, {{"RWE", 0, 255, 8}, {"RW", 0, 255, 8}}},
    both(8, {"R~", 0, 1, 0}),              both(9, {"R~", 0, 1, 0}),
    both(10, {"R~", 0, 1, 0}),             both(11, {"R~", 0, 1, 0}),
    both(12, {"RWE", 0, 1, 1}),            both(13, {"RWE", 0, 1, 1}),
    both(130, {"RWE", 1, 2047, 1}),        both(135, {"R~", -2047, 2047, 0}),
    both(138, {"RW~", 0, 2, 0}),           {140, {{"RWE", 0, 8, 8}, {"RW", 0, 8, 8}}},
    {141, {{"RW", 0, 4095, 0}, missing}},     both(149, {"RWE", 0, 1, 0}),
    both(150, {"RW", 0, 1, 0}),            both(153, {"RWE", 0, 13, 7}),
    both(154, {"RWE", 0, 13, 3}),          both(160, {"RW", 0, 1, 0}),
    both(161, {"RW", 0, 1, 0}),            both(162, {"RW", 0, 3, 2}),
    both(163, {"RW", 0, 1, 0}),            {164, {{"RW", 0, 3, 0}, {"RW", 0, 1, 0}}},
    both(165, {"RW", 0, 15, 2}),           both(166, {"RW", 0, 8, 3}),
    both(167, {"RW", 0, 15, 5}),           both(168, {"RW", 0, 1, 0}),
    both(169, {"RW", 0, 3, 0}),            both(170, {"RW", 0, 15, 0}),
    both(171, {"RW", 0, 3, 0}),            both(172, {"RW", 0, 15, 0}),
    both(173, {"RW", 0, 1, 1}),            both(174, {"RW", -64, 63, 5}),
    both(175, {"RW", 0, 3, 3}),            both(176, {"RW", 0, 3, 3}),
    both(177, {"RW", 0, 1, 0}),            both(178, {"RW", 0, 3, 0}),
    both(179, {"R", 0, 1, 1}),             both(180, {"R~", 0, 31, 0}),
    both(181, {"RW", 0, 2047, 0}),         both(182, {"RW", 0, 2047, 0}),
    both(183, {"RW", 0, 255, 0}),          both(184, {"RW", 0, 1, 0}),
    {193, {{"RWE", 1, 136, 1}, {"RW", 1, 136, 1}}},
    {194, {{"RWE", 0, 2047, 500}, {"RW", 0, 2047, 500}}},
    {195, {{"RWE", 0, 2047, 100}, {"RW", 0, 2047, 100}}},
    both(196, {"R~", lowest, highest, 0}), both(197, {"R~", lowest, highest, 0}),
    {200, {missing, {"RW", 0, 255, 0}}},      both(204, {"RWE", 0, 65535, 0}),
    both(206, {"R~", 0, 1023, 0}),         both(207, {"R~", 0, 3, 0}),
    both(208, {"R~", 0, 255, 0}),          both(209, {"RW~", lowest, highest, 0}),
    {210, {{"RWE", lowest, highest, 25600}, {"RW", lowest, highest, 25600}}},
    {212, {{"RWE", 0, 65535, 0}, {"RW", 0, highest, 0}}},
    {213, {{"RW", 0, 255, 0}, missing}},      both(214, {"RWE", 1, 65535, 200}),
    {215, {missing, {"R~", 0, 1023, 0}}},     {254, {{"RWE", 0, 1, 0}, {"RWE", 0, 5, 0}}},
};

// PD-1161 manual table 18; for the TMCM-1110 as above.
constexpr Row global_rows[] = {
    {64, {{"RWA", 0, 255, 0xE4}, missing}},  {65, {{"RWA", 0, 11, 0}, {"RWA", 0, 8, 0}}},
    both(66, {"RWA", 1, 255, 1}),         {67, {missing, {"RWA", 0, 63, 0}}},
    both(68, {"RWA", 0, 65535, 0}),       {69, {{"RWA", 2, 8, 8}, missing}},
    {70, {{"RWA", 0, 0x7FF, 2}, missing}},   {71, {{"RWA", 0, 0x7FF, 1}, missing}},
    {73, {{"RWA", 0, 1, 0}, missing}},       both(75, {"RWA", 0, 255, 0}),
    both(76, {"RWA", 0, 255, 2}),         both(77, {"RWA", 0, 1, 0}),
    {78, {{"RWA", 0, 63, 0}, missing}},      both(79, {"RWA", 0, 1, 0}),
    both(81, {"RWA", 0, 3, 0}),           {82, {{"RWA", 0, 65535, 0}, missing}},
    {83, {{"RWA", 0, 0x7FF, 0}, missing}},   both(84, {"RWA", 0, 1, 0}),
    both(85, {"RWA", 0, 1, 0}),           {86, {{"RWA", 0, 15, 0}, missing}},
    both(87, {"RWA", 0, 255, 0}),         both(90, {"RWA", 0, 1, 0}),
    both(128, {"R~", 0, 3, 0}),           both(129, {"R", 0, 1, 0}),
    both(130, {"R~", 0, 65535, 0}),       both(132, {"RW~", 0, highest, 0}),
    both(133, {"RW~", 0, highest, 0}),    both(255, {"RW", 0, 1, 0}),
};
// clang-format on

template <std::size_t count>
const ParameterRule* find(const Row (&rows)[count], ModuleId module, std::uint8_t number) {
  for (const Row& row : rows) {
    const ParameterRule& rule = row.rules[module == ModuleId::pd1161 ? 1 : 0];
    if (row.number == number && *rule.access != '\0') return &rule;
  }
  return nullptr;
}

/// Parameter 193: modes 1 to 8; 128 more inverts the home switch of modes 5 to 8; on the PD-1161 64 more takes the
/// right switch in modes 1 to 4 (PD-1161 manual chapters 4 and 7.1).
bool is_reference_search_mode(ModuleId module, std::int32_t value) {
  const bool is_plain = value >= 1 && value <= 8;
  const bool is_inverted = value >= 133 && value <= 136;
  const bool is_right = value >= 65 && value <= 68;
  return is_plain || is_inverted || (is_right && module == ModuleId::pd1161);
}

/// Parameter 210 of the TMCM-1110: 4 clears the encoder at the next null event and is over then, 8 more at every one.
constexpr std::int32_t clear_at_null = 4;
constexpr std::int32_t at_every_null = 8;

bool clears_once(ModuleId module, std::int32_t prescaler) {
  return module == ModuleId::tmcm1110 && (prescaler & clear_at_null) != 0 && (prescaler & at_every_null) == 0;
}

/// Bank 3: the period of a timer, the edges of a switch or an input, or nothing.
enum class InterruptSetting : std::uint8_t { none, period, edge };

InterruptSetting interrupt_setting(ModuleId module, std::uint8_t number) {
  if (number <= 2) return InterruptSetting::period;
  if (number == 27 || number == 28) return InterruptSetting::edge;
  const std::uint8_t last_input = module == ModuleId::pd1161 ? 42 : 44;
  return number >= 39 && number <= last_input ? InterruptSetting::edge : InterruptSetting::none;
}

}  // namespace

bool ParameterRule::allows(char letter) const {
  return std::strchr(access, letter) != nullptr;
}

const ParameterRule* axis_parameter_rule(ModuleId module, std::uint8_t number) {
  return find(axis_rows, module, number);
}
const ParameterRule* global_parameter_rule(ModuleId module, std::uint8_t number) {
  return find(global_rows, module, number);
}

ReferenceModule::ReferenceModule(ModuleId module) : module_(module) {
  load();
}

std::int32_t ReferenceModule::global(std::uint8_t number) const {
  const auto found = global_.find(number);
  return found == global_.end() ? 0 : found->second;
}

/// Takes over what the EEPROM holds, and defaults for all else.
void ReferenceModule::load() {
  for (const Row& row : axis_rows) {
    const ParameterRule* rule = axis_parameter_rule(module_, row.number);
    if (rule == nullptr) continue;
    const auto stored = eeprom_.axis.find(row.number);
    axis_[row.number] = stored == eeprom_.axis.end() ? rule->default_value : stored->second;
  }
  for (const Row& row : global_rows) {
    const ParameterRule* rule = global_parameter_rule(module_, row.number);
    if (rule == nullptr) continue;
    const auto stored = eeprom_.global.find(row.number);
    global_[row.number] = stored == eeprom_.global.end() ? rule->default_value : stored->second;
  }
  interrupts_.clear();
  variables_.fill(0);
  coordinates_.fill(0);
  if (global(85) == 0) std::copy(eeprom_.variables.begin(), eeprom_.variables.end(), variables_.begin());
  if (global(84) == 1) coordinates_ = eeprom_.coordinates;
  accumulator_ = 0;
  mode_is_known_ = false;
}

void ReferenceModule::restart() {
  const auto magic = eeprom_.global.find(64);
  if (magic != eeprom_.global.end() && magic->second != 0xE4) eeprom_ = {};
  load();
}

void ReferenceModule::restore_factory_settings() {
  eeprom_ = {};
  load();
}

Expectation ReferenceModule::request(std::uint8_t request_address, const Command& command) {
  prescaler_is_asked_for_ = false;
  Expectation expectation;
  expectation.is_answered = request_address == address();
  const bool is_for_group = group_address() != 0 && request_address == group_address();
  if (!expectation.is_answered && !is_for_group) return expectation;
  const Result result = execute(command);
  if (global(255) == 1 && command.opcode != ref_gap && command.opcode != ref_ggp) expectation.is_answered = false;
  expectation.host_address = static_cast<std::uint8_t>(global(76));
  expectation.module_address = address();
  expectation.status = result.status;
  expectation.lowest = result.lowest;
  expectation.highest = result.highest;
  return expectation;
}

void ReferenceModule::observe(std::int32_t value) {
  if (prescaler_is_asked_for_) axis_[210] = value;
  prescaler_is_asked_for_ = false;
  if (!unknown_coordinate_) return;
  coordinates_[*unknown_coordinate_] = value;
  if (global(84) == 1 && *unknown_coordinate_ != 0) eeprom_.coordinates[*unknown_coordinate_] = value;
  unknown_coordinate_.reset();
}

ReferenceModule::Result ReferenceModule::execute(const Command& command) {
  switch (command.opcode) {
    case ref_sap:
    case ref_gap:
    case ref_stap:
    case ref_rsap:
    case ref_aap:
      return axis_command(command);
    case ref_sgp:
    case ref_ggp:
    case ref_stgp:
    case ref_rsgp:
    case ref_agp:
      return global_command(command);
    case ref_sco:
    case ref_gco:
    case ref_cco:
    case ref_aco:
      return coordinate_command(command);
    case ref_calc:
      if (command.type != ref_calc_load) break;
      accumulator_ = command.value;
      return {ok, command.value, command.value};
    default:
      break;
  }
  return {invalid_command, command.value, command.value};
}

std::uint8_t ReferenceModule::set_axis_parameter(std::uint8_t number, std::int32_t value) {
  const ParameterRule* rule = axis_parameter_rule(module_, number);
  if (rule == nullptr || !rule->allows('W')) return wrong_type;
  if (value < rule->minimum || value > rule->maximum) return invalid_value;
  if (number == 193 && !is_reference_search_mode(module_, value)) return invalid_value;
  axis_[number] = value;
  mode_is_known_ = number == 138;
  return ok;
}

ReferenceModule::Result ReferenceModule::axis_command(const Command& command) {
  const auto answer = [&command](std::uint8_t status) { return Result{status, command.value, command.value}; };
  const bool mode_was_known = mode_is_known_;
  mode_is_known_ = false;
  if (command.motor != 0) return answer(invalid_value);
  if (command.opcode == ref_sap) return answer(set_axis_parameter(command.type, command.value));
  if (command.opcode == ref_aap) return answer(set_axis_parameter(command.type, accumulator_));

  const ParameterRule* rule = axis_parameter_rule(module_, command.type);
  if (rule == nullptr || !rule->allows(command.opcode == ref_gap ? 'R' : 'E')) return answer(wrong_type);
  const std::int32_t value = axis_[command.type];
  if (command.opcode == ref_gap) {
    const bool is_known = !rule->allows('~') || (command.type == 138 && mode_was_known);
    if (!is_known) return {ok, rule->minimum, rule->maximum};
    if (command.type == 210 && clears_once(module_, value)) {
      prescaler_is_asked_for_ = true;
      return {ok, value - clear_at_null, value};
    }
    return {ok, value, value};
  }
  if (command.opcode == ref_stap) {
    if (is_locked()) return answer(eeprom_locked);
    eeprom_.axis[command.type] = value;
    return answer(ok);
  }
  const auto stored = eeprom_.axis.find(command.type);
  axis_[command.type] = stored == eeprom_.axis.end() ? rule->default_value : stored->second;
  return answer(ok);
}

std::uint8_t ReferenceModule::set_global_parameter(std::uint8_t bank, std::uint8_t number, std::int32_t value) {
  if (bank == 2) {
    variables_[number] = value;
    return ok;
  }
  if (bank == 3) {
    const InterruptSetting setting = interrupt_setting(module_, number);
    if (setting == InterruptSetting::none) return wrong_type;
    // Periods are unsigned 32-bit numbers: every value is one.
    if (setting == InterruptSetting::edge && (value < 0 || value > 3)) return invalid_value;
    interrupts_[number] = value;
    return ok;
  }
  if (bank != 0) return invalid_value;
  const ParameterRule* rule = global_parameter_rule(module_, number);
  if (rule == nullptr || !rule->allows('W')) return wrong_type;
  if (number == 73) {
    if (value != 1234 && value != 4321) return invalid_value;
    value = value == 1234 ? 1 : 0;
  } else {
    if (value < rule->minimum || value > rule->maximum) return invalid_value;
    if (rule->allows('A') && is_locked()) return eeprom_locked;
  }
  global_[number] = value;
  if (rule->allows('A')) eeprom_.global[number] = value;
  return ok;
}

ReferenceModule::Result ReferenceModule::global_command(const Command& command) {
  const auto answer = [&command](std::uint8_t status) { return Result{status, command.value, command.value}; };
  const std::uint8_t bank = command.motor;
  const std::uint8_t number = command.type;
  if (command.opcode == ref_sgp) return answer(set_global_parameter(bank, number, command.value));
  if (command.opcode == ref_agp) return answer(set_global_parameter(bank, number, accumulator_));
  if (bank != 0 && bank != 2 && bank != 3) return answer(invalid_value);

  if (command.opcode == ref_ggp) {
    if (bank == 2) return {ok, variables_[number], variables_[number]};
    if (bank == 3) {
      if (interrupt_setting(module_, number) == InterruptSetting::none) return answer(wrong_type);
      return {ok, interrupts_[number], interrupts_[number]};
    }
    const ParameterRule* rule = global_parameter_rule(module_, number);
    if (rule == nullptr) return answer(wrong_type);
    if (rule->allows('~')) return {ok, rule->minimum, rule->maximum};
    return {ok, global(number), global(number)};
  }

  // STGP and RSGP: user variables 0 to 55. Bank 0 is stored by SGP already, so there they do nothing.
  const ParameterRule* rule = bank == 0 ? global_parameter_rule(module_, number) : nullptr;
  const bool is_stored = bank == 2 ? number < number_of_stored_variables : rule != nullptr && rule->allows('A');
  if (!is_stored) return answer(wrong_type);
  if (command.opcode == ref_stgp && is_locked()) return answer(eeprom_locked);
  if (bank == 2 && command.opcode == ref_stgp) eeprom_.variables[number] = variables_[number];
  if (bank == 2 && command.opcode == ref_rsgp) variables_[number] = eeprom_.variables[number];
  return answer(ok);
}

std::uint8_t ReferenceModule::set_coordinate(std::uint8_t number, std::int32_t value) {
  const bool is_stored = number != 0 && global(84) == 1;
  if (is_stored && is_locked()) return eeprom_locked;
  coordinates_[number] = value;
  if (is_stored) eeprom_.coordinates[number] = value;
  return ok;
}

ReferenceModule::Result ReferenceModule::coordinate_command(const Command& command) {
  const auto answer = [&command](std::uint8_t status) { return Result{status, command.value, command.value}; };
  const std::uint8_t number = command.type;
  const bool may_copy = command.opcode == ref_sco || command.opcode == ref_gco;
  const bool copies = may_copy && command.motor == 255;
  if (command.motor != 0 && !copies) return answer(invalid_value);
  if (number >= number_of_coordinates) return answer(wrong_type);
  if (copies) {
    if (command.opcode == ref_sco && is_locked()) return answer(eeprom_locked);
    auto& from = command.opcode == ref_sco ? coordinates_ : eeprom_.coordinates;
    auto& to = command.opcode == ref_sco ? eeprom_.coordinates : coordinates_;
    for (std::size_t n = 1; n < number_of_coordinates; ++n) {
      if (number == 0 || number == n) to[n] = from[n];
    }
    return answer(ok);
  }
  switch (command.opcode) {
    case ref_sco:
      return answer(set_coordinate(number, command.value));
    case ref_aco:
      return answer(set_coordinate(number, accumulator_));
    case ref_gco:
      return {ok, coordinates_[number], coordinates_[number]};
    default: {
      const std::uint8_t status = set_coordinate(number, 0);
      if (status == ok) unknown_coordinate_ = number;
      return {status, lowest, highest};
    }
  }
}

}  // namespace opentmcl::tests
