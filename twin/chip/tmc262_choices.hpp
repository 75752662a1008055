// What the TMC262 datasheet leaves open, and what this model does there: every such choice is in this file.
//
// Choices that are a computation are the functions below. The others:
//
// Registers and replies
//  * MSTEP is 0 after reset, as all registers are. It stands still while SPI sets the currents (SDOFF = 1).
//  * RDSEL = 3, reserved on this silicon, replies as 0. Words to the unassigned address do nothing.
//  * The status is taken when a word begins: it is the first thing that leaves the chip.
//
// Sequencer
//  * A full step ends where a coil changes its polarity, which is where bit 8 of MSTEP changes: there the sine table
//    has its end, and there the coils' currents can be compared. So it is with SPI currents, too (PHA, PHB);
//    a change of SDOFF itself ends none.
//  * A change of MRES does not move MSTEP: the text only advises where to change it.
//  * microPlyer gives out the first of its 16 microsteps with the STEP edge and the last one after 15/16 of the
//    period before: so a steady input becomes a steady output without a gap.
//  * The period is measured by the counter that also finds standstill, so it ends at 2^20 clocks: the first step
//    after a standstill is played in the longest usable period.
//  * INTPOL acts with MRES = 4 only; the sixteenfold output would leave the sine table with any other.
//  * With microPlyer, full steps end at the STEP edge that leads past them, up to 15/16 of a period early: what else
//    happens in the driver is then the same with and without.
//  * Switching microPlyer off jumps what it has not given out, as an early STEP does.
//
// stallGuard2 and coolStep
//  * No measurement without current in both coils.
//  * A change of SFILT begins a new filtered measurement.
//  * SG_TST shows an active stall from the measurement of 0 on until another value is measured; nothing is measured at
//    standstill.
//  * coolStep starts at CS, and goes back to it as soon as SEMIN is 0: that is what "off" can mean.
//  * A change of CS or SEIMIN moves the scale at once into the new limits, because SE is described as never outside.
//  * Measurements above the upper threshold count for a step down only if they follow each other: a load that comes
//    and goes shall not take the current away.
//
// Protection
//  * A short is detected once per chopper cycle, which begins when short, current and protection come together.
//  * Polarity changes count the detections down only when the short has gone: while it lasts, three cycles are over
//    before the next change at any speed that a motor can follow.
//  * A bridge that is shut off stays so until ENN or TOFF = 0 has switched the driver off; its temperature does not.
//    DISS2G ends the detection, not what it has done, and an undetected short has no effect in this model.
//  * An open-load flag is judged where its coil changes polarity, over the whole time since the last such change, and
//    stays as it is at standstill. Whether the current is above 1/16 is judged by CS.
//
// Chopper
//  * spreadCycle regulates to the mean of its two thresholds, which lie symmetrically around the target: no error.
//  * The blank time, the off time and the slopes shape the ripple, not the mean; RNDTF likewise.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/chip/tmc262_registers.hpp"

namespace opentmcl::twin::tmc262_choices {

/// MRES 9…15 act as 8: full steps.
constexpr std::int32_t microsteps_per_edge(tmc262::Word<tmc262::DriverControl> control) {
  return std::int32_t{1} << std::min(tmc262::DriverControl::Resolution::in(control), tmc262::maximum_resolution);
}

/// Weight of SGT. No source has it; with 10 the range of SGT moves the value by six tenths of its own range, which is
/// enough to tune any of the motors that these modules drive.
inline constexpr std::int32_t stall_guard_threshold_weight = 10;

/// What stallGuard2 shows of a measurement, which is made as if SGT were 0 and may lie outside of the range.
constexpr std::int32_t stall_guard_value(std::int64_t measurement, std::int32_t threshold) {
  const std::int64_t shifted = measurement + std::int64_t{stall_guard_threshold_weight} * threshold;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(shifted, 0, tmc262::maximum_stall_guard_value));
}

/// SFILT takes the mean of four full steps, one electrical turn: over it the differences between the two coils and
/// between their two polarities cancel, which is what the filter is recommended for.
inline constexpr std::int32_t filtered_full_steps = 4;

/// Lowest scale of coolStep: a half or a quarter of CS, rounded down. (n / 2 + 1) / 32 is never less than half of
/// (n + 1) / 32.
constexpr std::int32_t lowest_scale(std::int32_t current_scale, tmc262::Word<tmc262::CoolStepControl> control) {
  return current_scale >> (1 + tmc262::CoolStepControl::MinimumCurrent::in(control));
}

/// Constant off time: HEND adds -3…12 units of 1/512 to the magnitude of a coil current, which is given in units of
/// 1/256 (the table ends at 248, the converter at 255).
/// @return units of 1/512, 0…510
constexpr std::int32_t regulated_magnitude(std::int32_t magnitude,
                                           tmc262::Word<tmc262::ChopperConfiguration> configuration) {
  constexpr std::int32_t offset_of_code_zero = -3;
  const std::int32_t offset = tmc262::ChopperConfiguration::ConstantOffTime::is_set(configuration)
                                  ? tmc262::ChopperConfiguration::HysteresisEnd::in(configuration) + offset_of_code_zero
                                  : 0;
  return std::clamp(2 * magnitude + offset, 0, 2 * 255);
}

/// Length of a chopper cycle in clocks: two slow decay phases of 12 + 32 TOFF clocks that take half of it, the middle
/// of the 30…70 % that the datasheet advises. 43 µs with TOFF = 5 at 16 MHz.
constexpr std::uint64_t chopper_cycle(tmc262::Word<tmc262::ChopperConfiguration> configuration) {
  return 4 * (12 + 32 * static_cast<std::uint64_t>(tmc262::ChopperConfiguration::OffTime::in(configuration)));
}

/// Open load can be told above 1/16 of the full-scale current, (CS + 1) / 32 > 1/16.
constexpr bool shows_open_load(std::int32_t current_scale) {
  return current_scale + 1 > 2;
}

}  // namespace opentmcl::twin::tmc262_choices
