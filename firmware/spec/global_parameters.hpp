// Every global parameter of banks 0 and 2 of both modules; bank 3 is the `setting` column of interrupts.hpp.
// Sources: PD-1161 manual chapter 5 ("S0 5"), facts about the TMCM-1110 ("1110 a.3").
#pragma once

#include <cstddef>

#include "firmware/spec/modules.hpp"
#include "firmware/spec/parameter_rows.hpp"

namespace opentmcl {

/// The banks the motor/bank byte of SGP, GGP, STGP, RSGP and AGP can name.
enum class Bank : std::uint8_t { module_settings = 0, customer = 1, user_variables = 2, interrupt_settings = 3 };

/// Numbers in bank 0.
enum class GlobalParameter : std::uint8_t {
  eeprom_magic = 64,
  rs485_baud_rate = 65,
  serial_address = 66,
  ascii_mode = 67,
  serial_heartbeat = 68,
  can_bit_rate = 69,
  can_reply_id = 70,
  can_id = 71,
  eeprom_lock = 73,
  telegram_pause_time = 75,
  serial_host_address = 76,
  auto_start = 77,
  io_direction = 78,
  end_switch_polarity = 79,
  code_protection = 81,
  can_heartbeat = 82,
  can_secondary_id = 83,
  coordinate_storage = 84,
  do_not_restore_user_variables = 85,
  step_pulse_length = 86,
  serial_secondary_address = 87,
  reverse_shaft = 90,
  application_status = 128,
  download_mode = 129,
  program_counter = 130,
  tick_timer = 132,
  random_number = 133,
  suppress_reply = 255,
};

using GlobalParameterSpec = ParameterSpec<GlobalParameter>;

// clang-format off
inline constexpr GlobalParameterSpec global_parameters[] = {
    {GlobalParameter::eeprom_magic, "GPEepromMagic", "EEPROM magic", Unit::none, {{Access::rwa, 0, 255, 228}, absent},
     "Any value but 228 makes the next power-up restore the factory settings.", "1110 a.3"},
    {GlobalParameter::rs485_baud_rate, "GPBaudRate", "RS485 baud rate", Unit::none,
     {{Access::rwa, 0, 11, 0}, {Access::rwa, 0, 8, 0}},
     "0 9600, 1 14400, 2 19200, 3 28800, 4 38400, 5 57600, 6 76800, 7 115200, 8 230400, 9 250000, 10 500000, "
     "11 1000000; in force after a restart.",
     "S0 5.1, 1110 a.3"},
    {GlobalParameter::serial_address, "GPSerialAddress", "serial address", Unit::none,
     {{Access::rwa, 1, 255, 1}, {Access::rwa, 1, 255, 1}}, "Address the module answers to.", "S0 5.1"},
    {GlobalParameter::ascii_mode, "GPAsciiMode", "ASCII mode", Unit::none, {absent, {Access::rwa, 0, 63, 0}},
     "Bit 0: start in ASCII mode; bits 4 and 5: echo.", "S0 5.1"},
    {GlobalParameter::serial_heartbeat, "GPSerialHeartbeat", "serial heartbeat", Unit::milliseconds,
     {{Access::rwa, 0, 65535, 0}, {Access::rwa, 0, 65535, 0}},
     "Longest time without a command before the motor is stopped; 0 off.", "S0 5.1"},
    {GlobalParameter::can_bit_rate, "GPCanBitRate", "CAN bit rate", Unit::none, {{Access::rwa, 2, 8, 8}, absent},
     "2 20, 3 50, 4 100, 5 125, 6 250, 7 500, 8 1000 kbit/s; in force after a restart.", "1110 a.3"},
    {GlobalParameter::can_reply_id, "GPCanReplyId", "CAN reply id", Unit::none, {{Access::rwa, 0, 0x7FF, 2}, absent},
     "Identifier of replies.", "1110 a.3"},
    {GlobalParameter::can_id, "GPCanId", "CAN id", Unit::none, {{Access::rwa, 0, 0x7FF, 1}, absent},
     "Identifier of requests.", "1110 a.3"},
    {GlobalParameter::eeprom_lock, "GPEepromLock", "EEPROM lock", Unit::none, {{Access::rwa, 0, 4321, 0}, absent},
     "Write 1234 to lock the settings, 4321 to unlock them; reads 1 or 0.", "1110 a.3"},
    {GlobalParameter::telegram_pause_time, "GPTelegramPauseTime", "telegram pause time", Unit::milliseconds,
     {{Access::rwa, 0, 255, 0}, {Access::rwa, 0, 255, 0}}, "Pause before a reply over RS485.", "S0 5.1"},
    {GlobalParameter::serial_host_address, "GPSerialHostAddress", "serial host address", Unit::none,
     {{Access::rwa, 0, 255, 2}, {Access::rwa, 0, 255, 2}}, "First byte of each reply.", "S0 5.1"},
    {GlobalParameter::auto_start, "GPAutoStart", "auto start mode", Unit::none,
     {{Access::rwa, 0, 1, 0}, {Access::rwa, 0, 1, 0}}, "1: start the TMCL program at power-on.", "S0 5.1"},
    {GlobalParameter::io_direction, "GPIoDirection", "I/O direction", Unit::none, {{Access::rwa, 0, 63, 0}, absent},
     "One bit for each of the six general purpose lines: 1 output, 0 input.", "1110 a.3, a.5"},
    {GlobalParameter::end_switch_polarity, "GPEndSwitchPolarity", "end switch polarity", Unit::none,
     {{Access::rwa, 0, 1, 0}, {Access::rwa, 0, 1, 0}}, "1: a low level means that a limit switch is active.", "S0 5.1"},
    {GlobalParameter::code_protection, "GPCodeProtection", "TMCL code protection", Unit::none,
     {{Access::rwa, 0, 3, 0}, {Access::rwa, 0, 3, 0}},
     "1 against reading, 2 against overwriting, 3 both; leaving 1 or 3 erases the program first.", "S0 5.1"},
    {GlobalParameter::can_heartbeat, "GPCanHeartbeat", "CAN heartbeat", Unit::milliseconds,
     {{Access::rwa, 0, 65535, 0}, absent}, "As the serial heartbeat (68), for CAN.", "1110 a.3"},
    {GlobalParameter::can_secondary_id, "GPCanSecondaryId", "CAN secondary id", Unit::none,
     {{Access::rwa, 0, 0x7FF, 0}, absent}, "Second identifier of requests, never answered; 0 off.", "1110 a.3"},
    {GlobalParameter::coordinate_storage, "GPCoordinateStorage", "coordinate storage", Unit::none,
     {{Access::rwa, 0, 1, 0}, {Access::rwa, 0, 1, 0}},
     "1: coordinates 1 to 20 are kept in the EEPROM and restored at power-on.", "S0 5.1"},
    {GlobalParameter::do_not_restore_user_variables, "GPDoNotRestoreUserVariables", "do not restore user variables",
     Unit::none, {{Access::rwa, 0, 1, 0}, {Access::rwa, 0, 1, 0}}, "1: user variables start at 0.", "S0 5.1"},
    {GlobalParameter::step_pulse_length, "GPStepPulseLength", "step pulse length", Unit::none,
     {{Access::rwa, 0, 15, 0}, absent}, "Length of the step pulse: 1 + n µs.", "1110 a.3"},
    {GlobalParameter::serial_secondary_address, "GPSerialSecondaryAddress", "serial secondary address", Unit::none,
     {{Access::rwa, 0, 255, 0}, {Access::rwa, 0, 255, 0}},
     "Second address; commands to it are carried out and not answered. 0 off.", "S0 5.1, S0 7.4"},
    {GlobalParameter::reverse_shaft, "GPReverseShaft", "reverse shaft", Unit::none,
     {{Access::rwa, 0, 1, 0}, {Access::rwa, 0, 1, 0}}, "1: motor and encoder turn the other way.", "S0 5.1"},
    {GlobalParameter::application_status, "GPApplicationStatus", "TMCL application status", Unit::none,
     {{Access::r, 0, 3, 0}, {Access::r, 0, 3, 0}}, "0 stop, 1 run, 2 step, 3 reset.", "S0 5.1"},
    {GlobalParameter::download_mode, "GPDownloadMode", "download mode", Unit::none,
     {{Access::r, 0, 1, 0}, {Access::r, 0, 1, 0}}, "1 between commands 132 and 133.", "S0 5.1"},
    {GlobalParameter::program_counter, "GPProgramCounter", "TMCL program counter", Unit::none,
     {{Access::r, 0, 65535, 0}, {Access::r, 0, 65535, 0}}, "Address of the present instruction.", "S0 5.1"},
    {GlobalParameter::tick_timer, "GPTickTimer", "TMCL tick timer", Unit::milliseconds,
     {{Access::rw, 0, int32_maximum, 0}, {Access::rw, 0, int32_maximum, 0}}, "Counts milliseconds.", "S0 5.1"},
    {GlobalParameter::random_number, "GPRandomNumber", "random number", Unit::none,
     {{Access::rw, 0, int32_maximum, 0}, {Access::rw, 0, int32_maximum, 0}},
     "A new pseudo-random number at each read; writing sets the seed.", "S0 5.1"},
    {GlobalParameter::suppress_reply, "GPSuppressReply", "suppress reply", Unit::none,
     {{Access::rw, 0, 1, 0}, {Access::rw, 0, 1, 0}}, "1: only GAP, GGP and GIO are answered.", "S0 5.1"},
};
// clang-format on

inline constexpr std::size_t global_parameter_count = sizeof global_parameters / sizeof global_parameters[0];

/// Bank 2: 32-bit variables of the user; the first `stored_user_variable_count` can be stored (erratum E-40).
inline constexpr std::size_t user_variable_count = 256;
inline constexpr std::size_t stored_user_variable_count = 56;

/// Coordinates of SCO, GCO, CCO, ACO and MVP COORD; number 0 lives in RAM only. Source: S0 3.7.24.
inline constexpr std::size_t coordinate_count = 21;

/// Bit rates of CAN in bit/s by code of global parameter 69. Code 1 is of other modules. Source: 1110 a.3, c.2.
inline constexpr std::uint32_t can_bit_rates[] = {0,       10'000,  20'000,  50'000,   100'000,
                                                  125'000, 250'000, 500'000, 1'000'000};

/// The values global parameter 73 takes when written; it reads back 1 or 0.
inline constexpr std::int32_t eeprom_lock_code = 1234;
inline constexpr std::int32_t eeprom_unlock_code = 4321;

/// Baud rates of RS485 by the value of global parameter 65. Source: S0 5.1, 1110 a.3.
inline constexpr std::uint32_t rs485_baud_rates[] = {9600,  14400,  19200,  28800,  38400,  57600,
                                                     76800, 115200, 230400, 250000, 500000, 1000000};

/// Bits of global parameter 67. Source: S0 3.4.4.
inline constexpr std::int32_t start_in_ascii_mode = 0x01;
inline constexpr std::int32_t echo_lines = 0x10;
inline constexpr std::int32_t no_echo = 0x20;

/// What the value of commands 137 and 255 must be.
inline constexpr std::int32_t confirmation_code = 1234;

static_assert(is_parameter_table(global_parameters), "rows sorted and unique, each default within its range");

}  // namespace opentmcl
