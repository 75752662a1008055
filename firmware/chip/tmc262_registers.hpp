// TMC262 stepper driver: words, registers and fields, once, for the driver and for the chip model.
// Bit positions: TMC2660C datasheet, chapter 7 (the same silicon family); where the generations differ, the plain
// TMC262. Names are the datasheet's meaning in full; its symbol stands in the comment.
#pragma once

#include <cstdint>

#include "firmware/chip/register_field.hpp"

namespace opentmcl::tmc262 {

using chip::Field;
using chip::Flag;
using chip::Word;

// ---- Constants ---------------------------------------------------------------------------------------------------

inline constexpr unsigned word_bits = 20;
inline constexpr std::uint32_t word_mask = 0xFFFFF;
inline constexpr std::uint32_t microstep_positions = 1024;     ///< MSTEP counts modulo 1024: four full steps
inline constexpr std::uint32_t microsteps_per_fullstep = 256;  ///< positions per full step
inline constexpr std::uint32_t standstill_clocks = 1u << 20;   ///< clocks without a step until STST, chapter 8.4
inline constexpr std::int32_t maximum_current_scale = 31;      ///< CS and SE, in (n + 1) / 32
inline constexpr std::int32_t maximum_resolution = 8;          ///< MRES 9…15 are not defined
inline constexpr std::int32_t maximum_stall_guard_value = 1023;
inline constexpr std::int32_t coil_current_amplitude = 248;  ///< peak of the microstep table, chapter 8.2

// ---- Registers: each type knows the bits that select it; fields by name -------------------------------------------

/// DRVCTRL while Step/Dir drives the motor (SDOFF = 0).
struct DriverControl {
  static constexpr std::uint32_t select = 0x00000;
  using Interpolation = Flag<DriverControl, 9>;    // INTPOL: each STEP becomes 16 microsteps, with resolution 4
  using StepOnBothEdges = Flag<DriverControl, 8>;  // DEDGE
  using Resolution = Field<DriverControl, 0, 4>;   // MRES: 256 >> n microsteps per full step, n = 0…8
};

/// DRVCTRL while SPI sets the coil currents (SDOFF = 1).
struct CoilCurrents {
  static constexpr std::uint32_t select = 0x00000;
  using SignA = Flag<CoilCurrents, 17>;          // PHA: 0 = OA1 to OA2
  using MagnitudeA = Field<CoilCurrents, 9, 8>;  // CA, 0…248
  using SignB = Flag<CoilCurrents, 8>;           // PHB
  using MagnitudeB = Field<CoilCurrents, 0, 8>;  // CB, 0…248
};

/// CHOPCONF. Two fields mean something else with constant off time; they are named for both uses.
struct ChopperConfiguration {
  static constexpr std::uint32_t select = 0x80000;
  using BlankTime = Field<ChopperConfiguration, 15, 2>;            // TBL: 16, 24, 36, 54 clocks
  using ConstantOffTime = Flag<ChopperConfiguration, 14>;          // CHM: 0 = spreadCycle
  using RandomOffTime = Flag<ChopperConfiguration, 13>;            // RNDTF
  using HysteresisDecrement = Field<ChopperConfiguration, 11, 2>;  // HDEC: every 16, 32, 48, 64 clocks
  using FastDecayByTimerOnly = Flag<ChopperConfiguration, 12>;     // HDEC1 with CHM = 1
  using FastDecayTimeTopBit = Flag<ChopperConfiguration, 11>;      // HDEC0 with CHM = 1
  using HysteresisEnd = Field<ChopperConfiguration, 7, 4>;         // HEND: code - 3 = -3…12; CHM = 1: sine offset
  using HysteresisStart = Field<ChopperConfiguration, 4, 3>;       // HSTRT: code + 1 = 1…8; CHM = 1: fast decay time
  using OffTime = Field<ChopperConfiguration, 0, 4>;               // TOFF: 12 + 32 n clocks; 0 = bridges off
};

/// SMARTEN: coolStep.
struct CoolStepControl {
  static constexpr std::uint32_t select = 0xA0000;
  using MinimumCurrent = Field<CoolStepControl, 15, 1>;   // SEIMIN: 0 = 1/2, 1 = 1/4 of CS
  using CurrentDownStep = Field<CoolStepControl, 13, 2>;  // SEDN: one down per 32, 8, 2, 1 measurements
  using HysteresisWidth = Field<CoolStepControl, 8, 4>;   // SEMAX: upper threshold = 32 * (SEMIN + SEMAX + 1)
  using CurrentUpStep = Field<CoolStepControl, 5, 2>;     // SEUP: 1, 2, 4, 8 up per measurement
  using HysteresisStart = Field<CoolStepControl, 0, 4>;   // SEMIN: lower threshold = 32 * SEMIN; 0 = coolStep off
};

/// SGCSCONF: stallGuard2 and current scale.
struct StallGuardAndCurrent {
  static constexpr std::uint32_t select = 0xC0000;
  using Filter = Flag<StallGuardAndCurrent, 16>;              // SFILT: a value every four full steps
  using Threshold = Field<StallGuardAndCurrent, 8, 7, true>;  // SGT: -64…63, lower = more sensitive
  using CurrentScale = Field<StallGuardAndCurrent, 0, 5>;     // CS: (n + 1) / 32 of full scale
};

/// RDSEL: what the upper bits of the following replies carry.
enum class ReplyFormat : std::uint8_t {
  microstep_position = 0,
  stall_guard = 1,
  stall_guard_and_current = 2,
  reserved = 3,
};

/// DRVCONF.
struct DriverConfiguration {
  static constexpr std::uint32_t select = 0xE0000;
  using TestMode = Flag<DriverConfiguration, 16>;                // TST, must be 0
  using SlopeHigh = Field<DriverConfiguration, 14, 2>;           // SLPH
  using SlopeLow = Field<DriverConfiguration, 12, 2>;            // SLPL
  using DisableShortProtection = Flag<DriverConfiguration, 10>;  // DISS2G
  using ShortDetectionTime = Field<DriverConfiguration, 8, 2>;   // TS2G: 3.2, 1.6, 1.2, 0.8 µs
  using StepDirOff = Flag<DriverConfiguration, 7>;               // SDOFF: 1 = coil currents by SPI
  using LowSenseVoltage = Flag<DriverConfiguration, 6>;          // VSENSE: 165 mV instead of 310 mV full scale
  using Format = Field<DriverConfiguration, 4, 2>;               // RDSEL
  static constexpr Word<DriverConfiguration> of(ReplyFormat format) {
    return Format::of(static_cast<std::int32_t>(format));
  }
  static constexpr ReplyFormat reply_format_in(Word<DriverConfiguration> word) {
    return static_cast<ReplyFormat>(Format::in(word));
  }
};

// ---- Words to the chip --------------------------------------------------------------------------------------------

/// The 20-bit word that sets a register. A register is always written as a whole.
template <class Register>
constexpr std::uint32_t datagram(Word<Register> word) {
  return Register::select | word.bits;
}

/// Which register a 20-bit word sets: bits 19…17, of which DRVCTRL looks at the upper two only.
enum class RegisterSelect : std::uint8_t {
  driver_control,  ///< DriverControl or CoilCurrents, as SDOFF says
  unassigned,      ///< bits 19…18 = %01
  chopper_configuration,
  cool_step_control,
  stall_guard_and_current,
  driver_configuration,
};

constexpr RegisterSelect register_select_of(std::uint32_t word) {
  constexpr RegisterSelect by_top_bits[8] = {
      RegisterSelect::driver_control,
      RegisterSelect::driver_control,
      RegisterSelect::unassigned,
      RegisterSelect::unassigned,
      RegisterSelect::chopper_configuration,
      RegisterSelect::cool_step_control,
      RegisterSelect::stall_guard_and_current,
      RegisterSelect::driver_configuration,
  };
  return by_top_bits[(word >> 17) & 7];
}

/// The register's bits of a word that register_select_of() gave to `Register`.
template <class Register>
constexpr Word<Register> word_in(std::uint32_t word) {
  constexpr std::uint32_t content = Register::select == 0 ? 0x3FFFF : 0x1FFFF;
  return {word & content};
}

// ---- Replies, chapter 7.10 ----------------------------------------------------------------------------------------

/// The 20 bits that come back with every word, in the format that RDSEL asked for *before* this word.
struct Reply {
  using MicrostepPosition = Field<Reply, 10, 10>;   // MSTEP, ReplyFormat::microstep_position
  using StallGuardValue = Field<Reply, 10, 10>;     // SG, ReplyFormat::stall_guard; 0 = highest load
  using StallGuardUpperBits = Field<Reply, 15, 5>;  // SG9…5, ReplyFormat::stall_guard_and_current
  using CurrentScale = Field<Reply, 10, 5>;         // SE, ReplyFormat::stall_guard_and_current
  using Flags = Field<Reply, 0, 8>;
  using Standstill = Flag<Reply, 7>;              // STST: no step for 2^20 clocks
  using OpenLoadB = Flag<Reply, 6>;               // OLB
  using OpenLoadA = Flag<Reply, 5>;               // OLA
  using ShortToGroundB = Flag<Reply, 4>;          // S2GB
  using ShortToGroundA = Flag<Reply, 3>;          // S2GA
  using OvertemperatureWarning = Flag<Reply, 2>;  // OTPW
  using Overtemperature = Flag<Reply, 1>;         // OT
  using StallGuardReached = Flag<Reply, 0>;       // SG
};

}  // namespace opentmcl::tmc262
