// Every TMCL instruction of both modules: what the executor checks, the assembler writes, the disassembler reads and
// the reference lists. Sources: PD-1161 manual 3.5 and 3.7 ("S0"), facts about both modules, errata as E-nn.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/spec/parameter_rows.hpp"

namespace opentmcl {

enum class Opcode : std::uint8_t {
  ror = 1,
  rol = 2,
  mst = 3,
  mvp = 4,
  sap = 5,
  gap = 6,
  stap = 7,
  rsap = 8,
  sgp = 9,
  ggp = 10,
  stgp = 11,
  rsgp = 12,
  rfs = 13,
  sio = 14,
  gio = 15,
  calc = 19,
  comp = 20,
  jc = 21,
  ja = 22,
  csub = 23,
  rsub = 24,
  ei = 25,
  di = 26,
  wait = 27,
  stop = 28,
  sco = 30,
  gco = 31,
  cco = 32,
  calcx = 33,
  aap = 34,
  agp = 35,
  cle = 36,
  vect = 37,
  reti = 38,
  aco = 39,
  calcvv = 40,
  calcva = 41,
  calcav = 42,
  calcvx = 43,
  calcxv = 44,
  calcv = 45,
  mvpa = 46,
  rst = 48,
  djnz = 49,
  rola = 50,
  rora = 51,
  siv = 55,
  giv = 56,
  aiv = 57,
  uf0 = 64,
  uf1 = 65,
  uf2 = 66,
  uf3 = 67,
  uf4 = 68,
  uf5 = 69,
  uf6 = 70,
  uf7 = 71,
  call = 80,
  stop_application = 128,
  run_application = 129,
  step_application = 130,
  reset_application = 131,
  enter_download_mode = 132,
  exit_download_mode = 133,
  read_program_memory = 134,
  get_application_status = 135,
  get_firmware_version = 136,
  restore_factory_settings = 137,
  request_position_reached = 138,
  enter_ascii_mode = 139,
  get_information = 157,
  software_reset = 255,
};

/// What an operand means. The kinds from `mvp_mode` on are written as words: see `keywords`.
enum class OperandKind : std::uint8_t {
  none,
  motor,
  motor_group,   ///< MVP: any value with COORD (E-51), else a motor
  motor_or_all,  ///< SCO, GCO: a motor, or 255 to copy between RAM and EEPROM
  bank,
  io_bank,
  axis_parameter,
  global_parameter,
  port,
  coordinate,
  velocity,
  position,
  value,
  ticks,  ///< 10 ms each; -1 takes the accumulator
  address,
  interrupt,
  variable,
  number,  ///< anything the instruction wants
  mvp_mode,
  rfs_action,
  calc_operation,
  calcx_operation,
  variable_operation,
  variable_value_operation,
  condition,
  wait_event,
  error_flag,
};

/// The field of the instruction an operand is written to.
enum class Field : std::uint8_t { none, type, motor, value };

struct OperandSpec {
  OperandKind kind = OperandKind::none;
  Field field = Field::none;
  std::int32_t minimum = 0;
  std::int32_t maximum = 0;
};

inline constexpr std::size_t maximum_operands = 3;

/// Subroutine calls that can be open at a time: further ones are ignored. Source: S0 3.7.20.
inline constexpr std::uint8_t maximum_open_calls = 8;

enum class Where : std::uint8_t {
  direct_and_program,
  program_only,  ///< direct mode answers "command not available" (docs/decisions/0006-program-only-commands.md)
  direct_only,   ///< TMCL control commands: cannot be stored in a program
};

struct InstructionSpec {
  Opcode opcode;
  const char* mnemonic;  ///< nullptr for control commands, which have none
  Where where;
  bool reads;  ///< in a program its result goes to the accumulator and sets the flags
  bool ascii;  ///< can be typed in ASCII mode
  Modules modules;
  OperandSpec operands[maximum_operands];  ///< in the order of the mnemonic form
  const char* description;
  const char* source;
};

namespace spec_detail {
inline constexpr Where both = Where::direct_and_program;
inline constexpr Where program = Where::program_only;
inline constexpr Where direct = Where::direct_only;

inline constexpr OperandSpec motor{OperandKind::motor, Field::motor, 0, 255};
inline constexpr OperandSpec velocity{OperandKind::velocity, Field::value, -2047, 2047};
inline constexpr OperandSpec axis_parameter{OperandKind::axis_parameter, Field::type, 0, 255};
inline constexpr OperandSpec global_parameter{OperandKind::global_parameter, Field::type, 0, 255};
inline constexpr OperandSpec bank{OperandKind::bank, Field::motor, 0, 255};
inline constexpr OperandSpec port{OperandKind::port, Field::type, 0, 255};
inline constexpr OperandSpec io_bank{OperandKind::io_bank, Field::motor, 0, 255};
inline constexpr OperandSpec coordinate{OperandKind::coordinate, Field::type, 0, coordinate_count - 1};
inline constexpr OperandSpec value{OperandKind::value, Field::value, int32_minimum, int32_maximum};
inline constexpr OperandSpec address{OperandKind::address, Field::value, 0, 65535};
inline constexpr OperandSpec interrupt{OperandKind::interrupt, Field::type, 0, 255};
inline constexpr OperandSpec condition{OperandKind::condition, Field::type, 0, 12};
inline constexpr OperandSpec variable{OperandKind::variable, Field::motor, 0, user_variable_count - 1};
inline constexpr OperandSpec variable_operation{OperandKind::variable_operation, Field::type, 0, 11};
inline constexpr OperandSpec mvp_mode{OperandKind::mvp_mode, Field::type, 0, 2};
inline constexpr OperandSpec any_type{OperandKind::number, Field::type, 0, 255};
inline constexpr OperandSpec any_motor{OperandKind::number, Field::motor, 0, 255};
inline constexpr OperandSpec any_value{OperandKind::number, Field::value, int32_minimum, int32_maximum};
}  // namespace spec_detail

// clang-format off
inline constexpr InstructionSpec instructions[] = {
    {Opcode::ror, "ROR", spec_detail::both, false, true, Modules::both, {spec_detail::motor, spec_detail::velocity},
     "Rotate right: velocity mode, increasing position.", "S0 3.7.1, E-11"},
    {Opcode::rol, "ROL", spec_detail::both, false, true, Modules::both, {spec_detail::motor, spec_detail::velocity},
     "Rotate left: velocity mode, decreasing position.", "S0 3.7.2"},
    {Opcode::mst, "MST", spec_detail::both, false, true, Modules::both, {spec_detail::motor},
     "Stop the motor along its ramp.", "S0 3.7.3"},
    {Opcode::mvp, "MVP", spec_detail::both, false, true, Modules::both,
     {spec_detail::mvp_mode, {OperandKind::motor_group, Field::motor, 0, 255},
      {OperandKind::position, Field::value, int32_minimum, int32_maximum}},
     "Move to an absolute position, by an offset, or to a stored coordinate.", "S0 3.7.4"},
    {Opcode::sap, "SAP", spec_detail::both, false, true, Modules::both,
     {spec_detail::axis_parameter, spec_detail::motor, spec_detail::value}, "Set an axis parameter.", "S0 3.7.5"},
    {Opcode::gap, "GAP", spec_detail::both, true, true, Modules::both,
     {spec_detail::axis_parameter, spec_detail::motor}, "Get an axis parameter.", "S0 3.7.6"},
    {Opcode::stap, "STAP", spec_detail::both, false, true, Modules::both,
     {spec_detail::axis_parameter, spec_detail::motor}, "Store an axis parameter in the EEPROM.", "S0 3.7.7, E-15"},
    {Opcode::rsap, "RSAP", spec_detail::both, false, true, Modules::both,
     {spec_detail::axis_parameter, spec_detail::motor}, "Restore an axis parameter from the EEPROM.", "S0 3.7.8"},
    {Opcode::sgp, "SGP", spec_detail::both, false, true, Modules::both,
     {spec_detail::global_parameter, spec_detail::bank, spec_detail::value},
     "Set a global parameter or user variable.", "S0 3.7.9"},
    {Opcode::ggp, "GGP", spec_detail::both, true, true, Modules::both,
     {spec_detail::global_parameter, spec_detail::bank}, "Get a global parameter or user variable.", "S0 3.7.10"},
    {Opcode::stgp, "STGP", spec_detail::both, false, true, Modules::both,
     {spec_detail::global_parameter, spec_detail::bank}, "Store a user variable in the EEPROM.", "S0 3.7.11"},
    {Opcode::rsgp, "RSGP", spec_detail::both, false, true, Modules::both,
     {spec_detail::global_parameter, spec_detail::bank}, "Restore a user variable from the EEPROM.", "S0 3.7.12"},
    {Opcode::rfs, "RFS", spec_detail::both, true, true, Modules::both,
     {{OperandKind::rfs_action, Field::type, 0, 2}, spec_detail::motor}, "Start, stop or query a reference search.",
     "S0 3.7.13"},
    {Opcode::sio, "SIO", spec_detail::both, false, true, Modules::both,
     {spec_detail::port, spec_detail::io_bank, spec_detail::value}, "Set a digital output.", "S0 3.7.14"},
    {Opcode::gio, "GIO", spec_detail::both, true, true, Modules::both, {spec_detail::port, spec_detail::io_bank},
     "Get a digital or analog input.", "S0 3.7.15"},
    {Opcode::calc, "CALC", spec_detail::both, false, false, Modules::both,
     {{OperandKind::calc_operation, Field::type, 0, 9}, spec_detail::value}, "Calculate with the accumulator.",
     "S0 3.7.16"},
    {Opcode::comp, "COMP", spec_detail::both, false, false, Modules::both, {spec_detail::value},
     "Compare the accumulator with a value.", "S0 3.7.17"},
    {Opcode::jc, "JC", spec_detail::program, false, false, Modules::both,
     {spec_detail::condition, spec_detail::address}, "Jump if a condition holds.", "S0 3.7.18, E-44"},
    {Opcode::ja, "JA", spec_detail::program, false, false, Modules::both, {spec_detail::address}, "Jump always.",
     "S0 3.7.19"},
    {Opcode::csub, "CSUB", spec_detail::program, false, false, Modules::both, {spec_detail::address},
     "Call a subroutine; ignored when 8 calls are open.", "S0 3.7.20"},
    {Opcode::rsub, "RSUB", spec_detail::program, false, false, Modules::both, {}, "Return from a subroutine.",
     "S0 3.7.21"},
    {Opcode::ei, "EI", spec_detail::both, false, false, Modules::both, {spec_detail::interrupt},
     "Enable an interrupt; 255 enables interrupt processing.", "S0 3.7.32"},
    {Opcode::di, "DI", spec_detail::both, false, false, Modules::both, {spec_detail::interrupt},
     "Disable an interrupt; 255 disables interrupt processing.", "S0 3.7.33"},
    {Opcode::wait, "WAIT", spec_detail::program, false, false, Modules::both,
     {{OperandKind::wait_event, Field::type, 0, 4}, spec_detail::motor,
      {OperandKind::ticks, Field::value, -1, int32_maximum}},
     "Wait for an event; in all but TICKS the last operand is a timeout, 0 for none.", "S0 3.7.22"},
    {Opcode::stop, "STOP", spec_detail::program, false, false, Modules::both, {}, "End the program.", "S0 3.7.23"},
    {Opcode::sco, "SCO", spec_detail::both, false, true, Modules::both,
     {spec_detail::coordinate, {OperandKind::motor_or_all, Field::motor, 0, 255},
      {OperandKind::position, Field::value, int32_minimum, int32_maximum}},
     "Set a coordinate; with motor 255 copy one (or, with 0, all) to the EEPROM.", "S0 3.7.24"},
    {Opcode::gco, "GCO", spec_detail::both, true, true, Modules::both,
     {spec_detail::coordinate, {OperandKind::motor_or_all, Field::motor, 0, 255}},
     "Get a coordinate; with motor 255 copy one (or, with 0, all) from the EEPROM.", "S0 3.7.25, E-21"},
    {Opcode::cco, "CCO", spec_detail::both, false, true, Modules::both, {spec_detail::coordinate, spec_detail::motor},
     "Capture the actual position as a coordinate.", "S0 3.7.26, E-09"},
    {Opcode::calcx, "CALCX", spec_detail::both, false, false, Modules::both,
     {{OperandKind::calcx_operation, Field::type, 0, 10}}, "Calculate with accumulator and X register.", "S0 3.7.28"},
    {Opcode::aap, "AAP", spec_detail::both, false, false, Modules::both,
     {spec_detail::axis_parameter, spec_detail::motor}, "Accumulator to axis parameter.", "S0 3.7.29"},
    {Opcode::agp, "AGP", spec_detail::both, false, false, Modules::both,
     {spec_detail::global_parameter, spec_detail::bank}, "Accumulator to global parameter.", "S0 3.7.30"},
    {Opcode::cle, "CLE", spec_detail::both, false, false, Modules::both,
     {{OperandKind::error_flag, Field::type, 0, 5}}, "Clear an error flag.", "S0 3.7.31"},
    {Opcode::vect, "VECT", spec_detail::both, false, false, Modules::both,
     {spec_detail::interrupt, spec_detail::address}, "Define an interrupt vector.", "S0 3.7.34, E-03"},
    {Opcode::reti, "RETI", spec_detail::both, false, false, Modules::both, {}, "Return from an interrupt routine.",
     "S0 3.7.35, E-04"},
    {Opcode::aco, "ACO", spec_detail::both, false, false, Modules::both, {spec_detail::coordinate, spec_detail::motor},
     "Accumulator to coordinate.", "S0 3.7.27"},
    {Opcode::calcvv, "CALCVV", spec_detail::both, false, false, Modules::pd1161,
     {spec_detail::variable_operation, spec_detail::variable,
      {OperandKind::variable, Field::value, 0, user_variable_count - 1}},
     "Calculate with two user variables.", "S0 3.7.36, E-43"},
    {Opcode::calcva, "CALCVA", spec_detail::both, false, false, Modules::pd1161,
     {spec_detail::variable_operation, spec_detail::variable}, "Calculate a user variable with the accumulator.",
     "S0 3.7.37"},
    {Opcode::calcav, "CALCAV", spec_detail::both, false, false, Modules::pd1161,
     {spec_detail::variable_operation, spec_detail::variable}, "Calculate the accumulator with a user variable.",
     "S0 3.7.38, E-17"},
    {Opcode::calcvx, "CALCVX", spec_detail::both, false, false, Modules::pd1161,
     {spec_detail::variable_operation, spec_detail::variable}, "Calculate a user variable with the X register.",
     "S0 3.7.39"},
    {Opcode::calcxv, "CALCXV", spec_detail::both, false, false, Modules::pd1161,
     {spec_detail::variable_operation, spec_detail::variable}, "Calculate the X register with a user variable.",
     "S0 3.7.40"},
    {Opcode::calcv, "CALCV", spec_detail::both, false, false, Modules::pd1161,
     {{OperandKind::variable_value_operation, Field::type, 0, 11}, spec_detail::variable, spec_detail::value},
     "Calculate a user variable with a value.", "S0 3.7.41"},
    {Opcode::mvpa, "MVPA", spec_detail::both, false, false, Modules::pd1161,
     {spec_detail::mvp_mode, {OperandKind::motor_group, Field::motor, 0, 255}},
     "As MVP, to the position, offset or coordinate in the accumulator.", "S0 3.7.45"},
    {Opcode::rst, "RST", spec_detail::program, false, false, Modules::pd1161, {spec_detail::address},
     "Reset the interpreter and go on at an address.", "S0 3.7.42, E-05"},
    {Opcode::djnz, "DJNZ", spec_detail::program, false, false, Modules::pd1161,
     {{OperandKind::variable, Field::type, 0, user_variable_count - 1}, spec_detail::address},
     "Decrement a user variable and jump if it is not zero.", "S0 3.7.43, E-08, E-41"},
    {Opcode::rola, "ROLA", spec_detail::both, false, false, Modules::pd1161, {spec_detail::motor},
     "Rotate left with the velocity in the accumulator.", "S0 3.7.46"},
    {Opcode::rora, "RORA", spec_detail::both, false, false, Modules::pd1161, {spec_detail::motor},
     "Rotate right with the velocity in the accumulator.", "S0 3.7.47, E-06"},
    {Opcode::siv, "SIV", spec_detail::both, false, false, Modules::pd1161, {spec_detail::value},
     "Set the user variable the X register names.", "S0 3.7.48"},
    {Opcode::giv, "GIV", spec_detail::both, true, false, Modules::pd1161, {},
     "Get the user variable the X register names.", "S0 3.7.49, E-07"},
    {Opcode::aiv, "AIV", spec_detail::both, false, false, Modules::pd1161, {},
     "Accumulator to the user variable the X register names.", "S0 3.7.50"},
    {Opcode::uf0, "UF0", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 0.", "S0 3.7.51"},
    {Opcode::uf1, "UF1", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 1.", "S0 3.7.51"},
    {Opcode::uf2, "UF2", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 2.", "S0 3.7.51"},
    {Opcode::uf3, "UF3", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 3.", "S0 3.7.51"},
    {Opcode::uf4, "UF4", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 4.", "S0 3.7.51"},
    {Opcode::uf5, "UF5", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 5.", "S0 3.7.51"},
    {Opcode::uf6, "UF6", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 6.", "S0 3.7.51"},
    {Opcode::uf7, "UF7", spec_detail::both, false, true, Modules::both,
     {spec_detail::any_type, spec_detail::any_motor, spec_detail::any_value}, "User function 7.", "S0 3.7.51"},
    {Opcode::call, "CALL", spec_detail::program, false, false, Modules::pd1161,
     {spec_detail::condition, spec_detail::address}, "Call a subroutine if a condition holds.", "S0 3.7.44, E-12"},
    {Opcode::stop_application, nullptr, spec_detail::direct, false, false, Modules::both, {},
     "Stop the program; it can be continued.", "S0 3.7.53"},
    {Opcode::run_application, nullptr, spec_detail::direct, false, false, Modules::both,
     {{OperandKind::number, Field::type, 0, 1}, spec_detail::address},
     "Run the program, type 0 from where it stands, type 1 from an address.", "S0 3.7.53"},
    {Opcode::step_application, nullptr, spec_detail::direct, false, false, Modules::both, {},
     "Execute one instruction of the program.", "S0 3.7.53"},
    {Opcode::reset_application, nullptr, spec_detail::direct, false, false, Modules::both, {},
     "Stop the program and clear program counter, stack, registers and flags.", "S0 3.7.53"},
    {Opcode::enter_download_mode, nullptr, spec_detail::direct, false, false, Modules::both, {spec_detail::address},
     "Store all following commands but control commands, from an address on.", "S0 3.7.53"},
    {Opcode::exit_download_mode, nullptr, spec_detail::direct, false, false, Modules::both, {},
     "Execute commands again.", "S0 3.7.53"},
    {Opcode::read_program_memory, nullptr, spec_detail::direct, false, false, Modules::both, {spec_detail::address},
     "Read one instruction; special reply.", "S0 3.7.53, decision 0007"},
    {Opcode::get_application_status, nullptr, spec_detail::direct, false, false, Modules::both,
     {{OperandKind::number, Field::type, 0, 3}},
     "State and memory pointer, state and program counter, accumulator or X register.", "S0 3.7.53, E-45"},
    {Opcode::get_firmware_version, nullptr, spec_detail::direct, false, false, Modules::both,
     {{OperandKind::number, Field::type, 0, 1}}, "Version as a string (special reply) or as numbers.",
     "S0 3.7.53, E-48"},
    {Opcode::restore_factory_settings, nullptr, spec_detail::direct, false, false, Modules::both,
     {{OperandKind::number, Field::value, confirmation_code, confirmation_code}},
     "Restore the factory settings; no reply.", "S0 3.7.53"},
    {Opcode::request_position_reached, nullptr, spec_detail::direct, false, false, Modules::both,
     {{OperandKind::number, Field::type, 0, 1}, spec_detail::any_value},
     "Send a second reply when the target of the next (0) or each (1) MVP is reached.", "S0 3.7.52"},
    {Opcode::enter_ascii_mode, nullptr, spec_detail::direct, false, false, Modules::pd1161, {},
     "Enter the ASCII mode.", "S0 3.4.1"},
    {Opcode::get_information, nullptr, spec_detail::direct, false, false, Modules::both, {},
     "Asked by hosts for newer modules; answers \"command not available\".", "facts about hosts"},
    {Opcode::software_reset, nullptr, spec_detail::direct, false, false, Modules::both,
     {{OperandKind::number, Field::value, confirmation_code, confirmation_code}},
     "Restart the module as a power cycle does.", "S0 3.7.53"},
};
// clang-format on

inline constexpr std::size_t instruction_count = sizeof instructions / sizeof instructions[0];

/// A word that may stand for an operand.
struct Keyword {
  const char* word;
  std::uint8_t value;
  const char* description;
};

inline constexpr Keyword mvp_mode_words[] = {
    {"ABS", 0, "absolute"}, {"REL", 1, "relative to the actual position"}, {"COORD", 2, "stored coordinate"}};
inline constexpr Keyword rfs_action_words[] = {{"START", 0, "start"}, {"STOP", 1, "stop"}, {"STATUS", 2, "query"}};
/// CALC takes the first 10, CALCX the first 11, the instructions on variables all 12 (CALCV not SWAP).
inline constexpr Keyword operation_words[] = {
    {"ADD", 0, "add"},         {"SUB", 1, "subtract"},    {"MUL", 2, "multiply"},  {"DIV", 3, "divide"},
    {"MOD", 4, "remainder"},   {"AND", 5, "bitwise and"}, {"OR", 6, "bitwise or"}, {"XOR", 7, "bitwise xor"},
    {"NOT", 8, "bitwise not"}, {"LOAD", 9, "load"},       {"SWAP", 10, "swap"},    {"COMP", 11, "compare"}};
inline constexpr Keyword condition_words[] = {{"ZE", 0, "zero"},
                                              {"NZ", 1, "not zero"},
                                              {"EQ", 2, "equal"},
                                              {"NE", 3, "not equal"},
                                              {"GT", 4, "greater"},
                                              {"GE", 5, "greater or equal"},
                                              {"LT", 6, "lower"},
                                              {"LE", 7, "lower or equal"},
                                              {"ETO", 8, "timeout error"},
                                              {"EAL", 9, "external alarm"},
                                              {"EDV", 10, "deviation error"},
                                              {"EPO", 11, "position error"},
                                              {"ESD", 12, "shutdown error"}};
inline constexpr Keyword wait_event_words[] = {{"TICKS", 0, "time in units of 10 ms"},
                                               {"POS", 1, "target position reached"},
                                               {"REFSW", 2, "reference switch active"},
                                               {"LIMSW", 3, "limit switch active"},
                                               {"RFS", 4, "reference search ended"}};
inline constexpr Keyword error_flag_words[] = {{"ALL", 0, "all flags"},      {"ETO", 1, "timeout"},
                                               {"EAL", 2, "external alarm"}, {"EDV", 3, "deviation"},
                                               {"EPO", 4, "position"},       {"ESD", 5, "shutdown"}};

struct KeywordSet {
  const Keyword* words;
  std::size_t count;
  std::int32_t excluded;  ///< a value in the range that does not exist, or -1
};

/// The words an operand of this kind may be written as; empty for kinds that are numbers.
constexpr KeywordSet keywords_of(OperandKind kind) {
  switch (kind) {
    case OperandKind::mvp_mode:
      return {mvp_mode_words, 3, -1};
    case OperandKind::rfs_action:
      return {rfs_action_words, 3, -1};
    case OperandKind::calc_operation:
      return {operation_words, 10, -1};
    case OperandKind::calcx_operation:
      return {operation_words, 11, -1};
    case OperandKind::variable_operation:
      return {operation_words, 12, -1};
    case OperandKind::variable_value_operation:
      return {operation_words, 12, 10};
    case OperandKind::condition:
      return {condition_words, 13, -1};
    case OperandKind::wait_event:
      return {wait_event_words, 5, -1};
    case OperandKind::error_flag:
      return {error_flag_words, 6, -1};
    default:
      return {nullptr, 0, -1};
  }
}

/// A command that can only be typed, in ASCII mode, and what it stands for.
struct AsciiOnlyCommand {
  const char* word;
  Opcode opcode;
  std::uint8_t type;
  const char* description;
  const char* source;
};

inline constexpr AsciiOnlyCommand ascii_only_commands[] = {
    {"BIN", Opcode::enter_ascii_mode, 0, "Return to binary mode: what entered the ASCII mode leaves it.", "S0 3.4"},
    {"RUN", Opcode::run_application, 1, "Start the program at address 0.", "S0 3.4, decision 0017"},
    {"STOP", Opcode::stop_application, 0, "Stop the program.", "S0 3.4"},
};

/// Control commands are always executed, also in download mode, and can never be part of a program.
constexpr bool is_control_command(std::uint8_t opcode) {
  return opcode >= static_cast<std::uint8_t>(Opcode::stop_application);
}

consteval bool instructions_are_consistent() {
  int previous = -1;
  for (const InstructionSpec& row : instructions) {
    const int opcode = static_cast<int>(row.opcode);
    if (opcode <= previous) return false;
    previous = opcode;
    if (is_control_command(static_cast<std::uint8_t>(opcode)) != (row.mnemonic == nullptr)) return false;
    if ((row.where == Where::direct_only) != (row.mnemonic == nullptr)) return false;
    unsigned used = 0;
    for (const OperandSpec& operand : row.operands) {
      if (operand.kind == OperandKind::none) continue;
      const unsigned bit = 1U << static_cast<unsigned>(operand.field);
      if (operand.field == Field::none || (used & bit) != 0) return false;
      used |= bit;
      if (operand.minimum > operand.maximum) return false;
    }
  }
  return true;
}
static_assert(instructions_are_consistent(), "rows sorted and unique, each operand in a field of its own");

/// The row of an opcode that `module` has, or nullptr.
constexpr const InstructionSpec* find_instruction(std::uint8_t opcode, ModuleId module) {
  for (const InstructionSpec& row : instructions) {
    if (static_cast<std::uint8_t>(row.opcode) == opcode) return contains(row.modules, module) ? &row : nullptr;
  }
  return nullptr;
}

}  // namespace opentmcl
