// TMC429 motion controller: datagrams, registers and fields, once, for the driver and for the chip model.
// Bit positions: TMC429 datasheet rev. 2.06, register map on page 21 and the page named at each register.
// Names are the datasheet's meaning in full; its symbol stands in the comment.
#pragma once

#include <cstdint>

#include "firmware/chip/register_field.hpp"

namespace opentmcl::tmc429 {

using chip::Field;
using chip::Flag;
using chip::Word;

// ---- Constants ---------------------------------------------------------------------------------------------------

inline constexpr std::uint32_t clock_frequency = 16'000'000;  ///< Hz, on both modules
inline constexpr unsigned motor_count = 3;
inline constexpr std::uint32_t clock_prescaler = 32;  ///< clocks per tick of the ramp and pulse dividers, page 28
inline constexpr unsigned position_bits = 24;
inline constexpr std::int32_t maximum_divider = 13;           ///< PULSE_DIV, RAMP_DIV and PDIV
inline constexpr std::int32_t pulse_accumulator_size = 2048;  ///< velocity that would give a step on every pulse tick
inline constexpr unsigned velocity_fraction_bits = 8;         ///< hidden bits below V_ACTUAL, page 29
inline constexpr std::int32_t braking_distance_limit = 1 << 19;  ///< steps, page 26

// ---- Datagrams, pages 17 to 19 -----------------------------------------------------------------------------------

/// To the chip: RRS (0 registers, 1 RAM), SMDA (motor, 3 = common), IDX or JDX, RW (1 = read), data.
struct Datagram {
  using Ram = Flag<Datagram, 31>;          // RRS
  using Motor = Field<Datagram, 29, 2>;    // SMDA
  using Index = Field<Datagram, 25, 4>;    // IDX, JDX
  using Address = Field<Datagram, 25, 6>;  // SMDA and IDX together
  using Read = Flag<Datagram, 24>;         // RW
  using Data = Field<Datagram, 0, 24>;
};

/// From the chip, during every transfer: status byte and data.
struct Reply {
  using Interrupt = Flag<Reply, 31>;             // INT: some unmasked interrupt flag is set
  using CoverDatagramWaiting = Flag<Reply, 30>;  // CDGW, only with SPI drivers
  using LeftSwitch3 = Flag<Reply, 29>;           // RS3: left switch of motor 3 active
  using AtTarget3 = Flag<Reply, 28>;             // xEQt3: X_ACTUAL = X_TARGET of motor 3
  using LeftSwitch2 = Flag<Reply, 27>;           // RS2
  using AtTarget2 = Flag<Reply, 26>;             // xEQt2
  using LeftSwitch1 = Flag<Reply, 25>;           // RS1
  using AtTarget1 = Flag<Reply, 24>;             // xEQt1
  using Status = Field<Reply, 24, 8>;
  using Data = Field<Reply, 0, 24>;
};

/// The bits of the status byte as status_of() returns it.
struct Status {
  using Interrupt = Flag<Status, 7>;
  using CoverDatagramWaiting = Flag<Status, 6>;
  using LeftSwitch3 = Flag<Status, 5>;
  using AtTarget3 = Flag<Status, 4>;
  using LeftSwitch2 = Flag<Status, 3>;
  using AtTarget2 = Flag<Status, 2>;
  using LeftSwitch1 = Flag<Status, 1>;
  using AtTarget1 = Flag<Status, 0>;
};

/// Index (IDX) of a register that every motor has.
enum class AxisRegister : std::uint8_t {
  target_position = 0,       // X_TARGET
  actual_position = 1,       // X_ACTUAL
  minimum_velocity = 2,      // V_MIN
  maximum_velocity = 3,      // V_MAX
  target_velocity = 4,       // V_TARGET
  actual_velocity = 5,       // V_ACTUAL
  maximum_acceleration = 6,  // A_MAX
  actual_acceleration = 7,   // A_ACTUAL
  current_scaling = 8,       // IS_AGTAT, IS_ALEAT, IS_V0, A_THRESHOLD
  braking_factor = 9,        // PMUL, PDIV
  mode = 10,                 // lp, REF_CONF, RAMP_MODE
  interrupts = 11,           // INTERRUPT_MASK, INTERRUPT_FLAGS
  dividers = 12,             // PULSE_DIV, RAMP_DIV, USRS
  reference_tolerance = 13,  // DX_REF_TOLERANCE
  latched_position = 14,     // X_LATCHED
  microstep_counter = 15,    // USTEP_COUNT_429
};

/// Index (JDX) of a register that all motors share.
enum class CommonRegister : std::uint8_t {
  datagram_low_word = 0,
  datagram_high_word = 1,
  cover_position_and_length = 2,
  cover_datagram = 3,
  interface_configuration = 4,     // IF_CONFIGURATION_429
  compare_position = 5,            // POS_COMP_429
  compare_position_interrupt = 6,  // POS_COMP_INT_429
  power_down = 8,                  // POWER_DOWN: a write of any value
  type_version = 9,                // TYPE_VERSION_429
  reference_switches = 14,         // l3 r3 l2 r2 l1 r1
  global_parameters = 15,          // stepper motor global parameters, SMGP
};

/// Address of a register: RRS = 0, SMDA and index; 0x00…0x3F.
enum class Address : std::uint8_t {};

inline constexpr unsigned common_block = 3;  ///< SMDA of the common registers

/// `motor`: 0…2 for the datasheet's motors 1…3.
constexpr Address address_of(AxisRegister index, unsigned motor = 0) {
  return static_cast<Address>((motor << 4) | static_cast<unsigned>(index));
}

constexpr Address address_of(CommonRegister index) {
  return static_cast<Address>((common_block << 4) | static_cast<unsigned>(index));
}

constexpr std::uint32_t read_datagram(Address address) {
  return (Datagram::Address::of(static_cast<std::int32_t>(address)) | Datagram::Read::set).bits;
}

/// Bits of `data` above 23 are lost.
constexpr std::uint32_t write_datagram(Address address, std::uint32_t data) {
  return (Datagram::Address::of(static_cast<std::int32_t>(address)) | Word<Datagram>{data & Datagram::Data::mask}).bits;
}

constexpr Word<Status> status_of(std::uint32_t reply) {
  return {static_cast<std::uint32_t>(Reply::Status::in({reply}))};
}

constexpr std::uint32_t data_of(std::uint32_t reply) {
  return reply & Reply::Data::mask;
}

// ---- Axis registers: each type knows its index; fields by name ----------------------------------------------------

/// X_TARGET: where ramp_mode and soft_mode drive to. Wraps modulo 2^24; |X_TARGET - X_ACTUAL| < 2^23 (page 23).
struct TargetPosition {
  static constexpr AxisRegister index = AxisRegister::target_position;
  using Value = Field<TargetPosition, 0, position_bits, true>;
};

/// X_ACTUAL: counts the steps that were given out. A write in ramp_mode or soft_mode starts a motion (page 23).
struct ActualPosition {
  static constexpr AxisRegister index = AxisRegister::actual_position;
  using Value = Field<ActualPosition, 0, position_bits, true>;
};

/// V_MIN: velocity at or below which the motor may stop at once; at least 1 (page 24).
struct MinimumVelocity {
  static constexpr AxisRegister index = AxisRegister::minimum_velocity;
  using Value = Field<MinimumVelocity, 0, 11>;
};

/// V_MAX, 0…2047: limit of the velocity in all modes but hold_mode (page 24).
struct MaximumVelocity {
  static constexpr AxisRegister index = AxisRegister::maximum_velocity;
  using Value = Field<MaximumVelocity, 0, 11>;
};

/// V_TARGET: written by the user in velocity_mode, by the chip in ramp_mode and soft_mode (page 25).
struct TargetVelocity {
  static constexpr AxisRegister index = AxisRegister::target_velocity;
  using Value = Field<TargetVelocity, 0, 12, true>;
};

/// V_ACTUAL: integer part of the velocity; a write takes effect at once and clears the fraction (pages 25, 32).
struct ActualVelocity {
  static constexpr AxisRegister index = AxisRegister::actual_velocity;
  using Value = Field<ActualVelocity, 0, 12, true>;
};

/// A_MAX, 0…2047: added to the velocity, in 1/256 of its unit, on every ramp tick (page 29).
struct MaximumAcceleration {
  static constexpr AxisRegister index = AxisRegister::maximum_acceleration;
  using Value = Field<MaximumAcceleration, 0, 11>;
};

/// A_ACTUAL: smoothed and for display only (page 26).
struct ActualAcceleration {
  static constexpr AxisRegister index = AxisRegister::actual_acceleration;
  using Value = Field<ActualAcceleration, 0, 12, true>;
};

/// Current scaling of SPI drivers; without meaning in Step/Dir mode (page 26).
struct CurrentScaling {
  static constexpr AxisRegister index = AxisRegister::current_scaling;
  using AboveThreshold = Field<CurrentScaling, 20, 3>;         // IS_AGTAT
  using BelowThreshold = Field<CurrentScaling, 16, 3>;         // IS_ALEAT
  using AtRest = Field<CurrentScaling, 12, 3>;                 // IS_V0
  using AccelerationThreshold = Field<CurrentScaling, 0, 11>;  // A_THRESHOLD
};

/// PMUL, PDIV: p = Multiplier / 2^(3 + Divisor) decides where braking begins (page 28).
struct BrakingFactor {
  static constexpr AxisRegister index = AxisRegister::braking_factor;
  using Multiplier = Field<BrakingFactor, 8, 8>;  // PMUL with its top bit, which is always 1: 128…255
  using Divisor = Field<BrakingFactor, 0, 4>;     // PDIV, 0…13
  static constexpr Word<BrakingFactor> fixed{0x8000};
};

/// RAMP_MODE, page 32.
enum class RampMode : std::uint8_t {
  ramp = 0,      ///< trapezoidal move to X_TARGET
  soft = 1,      ///< as ramp, the velocity falls exponentially towards the target
  velocity = 2,  ///< moves to V_TARGET with A_MAX
  hold = 3,      ///< the user writes V_ACTUAL
};

/// lp, REF_CONF and RAMP_MODE, page 34.
struct Mode {
  static constexpr AxisRegister index = AxisRegister::mode;
  using LatchArmed = Flag<Mode, 16>;        // lp, read only
  using ReferenceIsRight = Flag<Mode, 11>;  // ref_RnL: which switch is the reference switch
  using SoftStop = Flag<Mode, 10>;          // soft_stop: stop switches stop with A_MAX, not at once
  using DisableRightStop = Flag<Mode, 9>;   // disable_stop_r
  using DisableLeftStop = Flag<Mode, 8>;    // disable_stop_l
  using Ramp = Field<Mode, 0, 2>;           // RAMP_MODE
  static constexpr Word<Mode> of(RampMode mode) { return Ramp::of(static_cast<std::int32_t>(mode)); }
  static constexpr RampMode ramp_mode_in(Word<Mode> word) { return static_cast<RampMode>(Ramp::in(word)); }
};

/// INTERRUPT_MASK and INTERRUPT_FLAGS, page 36. The mask of flag n is bit n + 8; a flag is cleared by writing 1 to it,
/// and every such write sets the mask as well.
struct Interrupts {
  static constexpr AxisRegister index = AxisRegister::interrupts;
  using Mask = Field<Interrupts, 8, 8>;
  using Flags = Field<Interrupts, 0, 8>;
  using PositionEnd = Flag<Interrupts, 0>;       // pos_end: target reached
  using ReferenceWrong = Flag<Interrupts, 1>;    // ref_wrong: reference switch active outside the tolerance
  using ReferenceMissed = Flag<Interrupts, 2>;   // ref_miss: reference switch not active at position 0
  using Stop = Flag<Interrupts, 3>;              // stop: a switch stopped the motor
  using LeftSwitchFalls = Flag<Interrupts, 4>;   // stop_left_low
  using RightSwitchFalls = Flag<Interrupts, 5>;  // stop_right_low
  using LeftSwitchRises = Flag<Interrupts, 6>;   // stop_left_high
  using RightSwitchRises = Flag<Interrupts, 7>;  // stop_right_high
};

/// PULSE_DIV, RAMP_DIV and USRS, pages 36 to 38.
struct Dividers {
  static constexpr AxisRegister index = AxisRegister::dividers;
  using Pulse = Field<Dividers, 12, 4>;               // PULSE_DIV: pulse tick every 32 * 2^n clocks, 0…13
  using Ramp = Field<Dividers, 8, 4>;                 // RAMP_DIV: ramp tick every 32 * 2^n clocks, 0…13
  using MicrostepResolution = Field<Dividers, 0, 3>;  // USRS, without meaning in Step/Dir mode
};

/// DX_REF_TOLERANCE: range around position 0 without automatic stop and ref_wrong (pages 35, 38).
struct ReferenceTolerance {
  static constexpr AxisRegister index = AxisRegister::reference_tolerance;
  using Value = Field<ReferenceTolerance, 0, 12>;
};

/// X_LATCHED: position at the last edge of the reference switch; a write of any value arms the latch (page 38).
struct LatchedPosition {
  static constexpr AxisRegister index = AxisRegister::latched_position;
  using Value = Field<LatchedPosition, 0, position_bits, true>;
};

/// USTEP_COUNT_429: pointer into the microstep table, SPI drivers only (page 38).
struct MicrostepCounter {
  static constexpr AxisRegister index = AxisRegister::microstep_counter;
  using Value = Field<MicrostepCounter, 0, 8>;
};

// ---- Common registers ---------------------------------------------------------------------------------------------

/// COVER_POSITION and COVER_LEN, SPI drivers only (page 41).
struct CoverPositionAndLength {
  static constexpr CommonRegister index = CommonRegister::cover_position_and_length;
  using Waiting = Flag<CoverPositionAndLength, 23>;      // cw
  using Position = Field<CoverPositionAndLength, 8, 6>;  // reads back as the written value + 1
  using Length = Field<CoverPositionAndLength, 0, 5>;
};

/// IF_CONFIGURATION_429, page 42.
struct InterfaceConfiguration {
  static constexpr CommonRegister index = CommonRegister::interface_configuration;
  using EnableRightSwitches = Flag<InterfaceConfiguration, 8>;  // en_refr: use the pins REFR1…REFR3
  using ComparedMotor = Field<InterfaceConfiguration, 6, 2>;    // pos_comp_sel: 0…2, 3 = none
  using EnableStepDir = Flag<InterfaceConfiguration, 5>;        // en_sd: Step/Dir drivers instead of SPI drivers
  using InvertDirection = Flag<InterfaceConfiguration, 4>;      // inv_dir: the pin only, no sign changes
  using InvertStep = Flag<InterfaceConfiguration, 3>;           // inv_stp
  using StepOnBothEdges = Flag<InterfaceConfiguration, 2>;      // step_half: STEP toggles once per step
  using InterruptOutput = Flag<InterfaceConfiguration, 1>;      // sdo_int: nINT_SDO_C is nINT only
  using InvertSwitches = Flag<InterfaceConfiguration, 0>;       // inv_ref: a low level means active
};

/// POS_COMP_429: position at which the POSCMP output is active (page 43).
struct ComparePosition {
  static constexpr CommonRegister index = CommonRegister::compare_position;
  using Value = Field<ComparePosition, 0, position_bits, true>;
};

/// POS_COMP_INT_429, page 43.
struct ComparePositionInterrupt {
  static constexpr CommonRegister index = CommonRegister::compare_position_interrupt;
  using Enabled = Flag<ComparePositionInterrupt, 8>;   // M
  using Occurred = Flag<ComparePositionInterrupt, 0>;  // I
};

/// TYPE_VERSION_429, page 43.
struct TypeVersion {
  static constexpr CommonRegister index = CommonRegister::type_version;
  static constexpr std::uint32_t value = 0x429101;  ///< version 1.01
};

/// The state of the reference switches after inv_ref and en_refr, 1 = active (page 45).
struct ReferenceSwitches {
  static constexpr CommonRegister index = CommonRegister::reference_switches;
  using Left3 = Flag<ReferenceSwitches, 5>;
  using Right3 = Flag<ReferenceSwitches, 4>;
  using Left2 = Flag<ReferenceSwitches, 3>;
  using Right2 = Flag<ReferenceSwitches, 2>;
  using Left1 = Flag<ReferenceSwitches, 1>;
  using Right1 = Flag<ReferenceSwitches, 0>;
};

/// Stepper motor global parameters (SMGP), pages 45 to 48 and 53.
struct GlobalParameters {
  static constexpr CommonRegister index = CommonRegister::global_parameters;
  using Motor1RightIsReference3 = Flag<GlobalParameters, 21>;  // mot1r: on the 16-pin part REF3 is motor 1's right
  using MultiplexSwitches = Flag<GlobalParameters, 20>;        // refmux, SPI drivers only
  using ContinuousUpdate = Flag<GlobalParameters, 16>;         // continuous_update, SPI drivers only
  using DriverClockDivider = Field<GlobalParameters, 8, 8>;    // CLK2_DIV, SPI drivers only
  using StepPulseLength = Field<GlobalParameters, 8, 4>;       // STPDIV_429: 16 * (1 + n) clocks, with en_sd only
  using CommonOrIndividualSelect = Flag<GlobalParameters, 7>;  // csCommonIndividual, SPI drivers only
  using Polarities = Field<GlobalParameters, 2, 5>;            // nscs_s, sck_s, ph_ab, fd_ab, dac_ab; SPI drivers only
  using LastDriver = Field<GlobalParameters, 0, 2>;            // LSMD, SPI drivers only; 3 is forbidden
  static constexpr Word<GlobalParameters> reset{0x000F00};
};

// ---- Datagrams from words: a word of one register cannot end up in another one
// ---------------------------------------

/// `motor` (0…2) is ignored for a common register.
template <class Register>
constexpr Address address_of_register(unsigned motor = 0) {
  if constexpr (requires { address_of(Register::index, motor); }) {
    return address_of(Register::index, motor);
  } else {
    return address_of(Register::index);
  }
}

template <class Register>
constexpr std::uint32_t write_datagram(Word<Register> word, unsigned motor = 0) {
  return write_datagram(address_of_register<Register>(motor), word.bits);
}

template <class Register>
constexpr std::uint32_t read_datagram(unsigned motor = 0) {
  return read_datagram(address_of_register<Register>(motor));
}

/// What the answer to read_datagram<Register>() carries.
template <class Register>
constexpr Word<Register> word_in(std::uint32_t reply) {
  return {data_of(reply)};
}

}  // namespace opentmcl::tmc429
