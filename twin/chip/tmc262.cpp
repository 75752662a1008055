#include "twin/chip/tmc262.hpp"

#include <algorithm>

#include "twin/chip/microstep_table.hpp"
#include "twin/chip/tmc262_choices.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::ChopperConfiguration;
using tmc262::CoilCurrents;
using tmc262::DriverConfiguration;
using tmc262::Reply;
using tmc262::ReplyFormat;
using tmc262::StallGuardAndCurrent;
using tmc262::Word;

constexpr std::int32_t warning_temperature = 100;
constexpr std::int32_t shutdown_temperature = 150;
constexpr std::int32_t high_sense_voltage = 310;
constexpr std::int32_t low_sense_voltage = 165;

/// Under-voltage lockout, in mV (TMC2660C datasheet 19.2).
constexpr std::int32_t reset_voltage = 7'000;

/// The units of regulated_magnitude() are half of those of the table.
constexpr std::int32_t regulated_units = 2;

std::int32_t regulated(std::int32_t current, Word<ChopperConfiguration> configuration) {
  const std::int32_t magnitude =
      tmc262_choices::regulated_magnitude(current < 0 ? -current : current, configuration) / regulated_units;
  return current < 0 ? -magnitude : magnitude;
}

}  // namespace

// ---- Registers

std::uint32_t Tmc262::transfer(std::uint32_t word, std::uint64_t clock) {
  advance(clock);
  if (!has_supply_) return 0;
  const Word<Reply> answer = reply();
  write(word & tmc262::word_mask);
  return answer.bits;
}

Word<Reply> Tmc262::reply() const {
  const std::int32_t stall_guard = stall_guard_.value();
  Word<Reply> answer;
  switch (DriverConfiguration::reply_format_in(registers_.driver_configuration)) {
    case ReplyFormat::microstep_position:
    case ReplyFormat::reserved:
      answer = Reply::MicrostepPosition::of(static_cast<std::int32_t>(sequencer_.position(clock_)));
      break;
    case ReplyFormat::stall_guard:
      answer = Reply::StallGuardValue::of(stall_guard);
      break;
    case ReplyFormat::stall_guard_and_current:
      answer = Reply::StallGuardUpperBits::of(stall_guard >> 5) | Reply::CurrentScale::of(current_scale());
      break;
  }
  return answer | Reply::Standstill::of(sequencer_.standstill(clock_)) | Reply::OpenLoadB::of(bridge_b_.open_load()) |
         Reply::OpenLoadA::of(bridge_a_.open_load()) | Reply::ShortToGroundB::of(bridge_b_.shut_off(clock_)) |
         Reply::ShortToGroundA::of(bridge_a_.shut_off(clock_)) |
         Reply::OvertemperatureWarning::of(temperature_ >= warning_temperature) |
         Reply::Overtemperature::of(temperature_ >= shutdown_temperature) |
         Reply::StallGuardReached::of(stall_guard_output());
}

void Tmc262::write(std::uint32_t word) {
  const Tmc262RegisterFile before = registers_;
  if (!registers_.write(word)) {
    ++unmodelled_writes_;
    latest_unmodelled_write_ = word;
  }
  if (!(registers_ == before)) apply_changes(before);
}

void Tmc262::apply_changes(const Tmc262RegisterFile& before) {
  if (!interpolates()) sequencer_.end_interpolation();
  const auto filters = [](const Tmc262RegisterFile& registers) {
    return StallGuardAndCurrent::Filter::is_set(registers.stall_guard_and_current);
  };
  if (filters(registers_) != filters(before)) stall_guard_.begin_again();
  cool_step_.apply(registers_);
  update_bridges();
  const auto changes = [&]<class Sign>(Sign) -> std::uint64_t {
    return Sign::is_set(registers_.coil_currents) != Sign::is_set(before.coil_currents) ? 1 : 0;
  };
  end_full_steps(changes(CoilCurrents::SignA{}), changes(CoilCurrents::SignB{}));
}

void Tmc262::update_bridges() {
  const bool has_off_time = ChopperConfiguration::OffTime::in(registers_.chopper_configuration) != 0;
  const Tmc262Bridge::Conditions conditions{
      .enabled = has_supply_ && !enable_not_ && has_off_time,
      .too_hot = temperature_ >= shutdown_temperature,
      .watches_for_shorts = !DriverConfiguration::DisableShortProtection::is_set(registers_.driver_configuration),
      .chopper_cycle = tmc262_choices::chopper_cycle(registers_.chopper_configuration)};
  bridge_a_.set_conditions(conditions, clock_);
  bridge_b_.set_conditions(conditions, clock_);
}

void Tmc262::reset() {
  registers_ = {};
  sequencer_ = Tmc262Sequencer(clock_);
  stall_guard_.reset();
  cool_step_ = {};
  bridge_a_.reset();
  bridge_b_.reset();
}

void Tmc262::power_up() {
  clock_ = 0;
  enable_not_ = false;
  unmodelled_writes_ = 0;
  latest_unmodelled_write_ = 0;
  reset();
  update_bridges();
}

// ---- Steps

std::int64_t Tmc262::steps(std::uint64_t count, StepSignal first, bool direction, std::uint64_t first_clock,
                           std::uint64_t last_clock) {
  if (count == 0 || !has_supply_ || registers_.step_dir_off()) return 0;
  const Tmc262StepRun run{count, first, first_clock, last_clock};
  const std::optional<std::uint64_t> shut_off = shut_off_after(first_clock);
  if (!shut_off || *shut_off > last_clock) return take(run, direction);
  // What a full step does depends on the bridges.
  const std::uint64_t before = run.count_before(*shut_off);
  const std::int64_t way = take({before, first, first_clock, run.clock_of(before - 1)}, direction);
  return way + steps(count - before, run.signal_of(before), direction, run.clock_of(before), last_clock);
}

std::int64_t Tmc262::take(const Tmc262StepRun& run, bool direction) {
  const Tmc262Sequencer::Movement movement = sequencer_.take(run, direction, registers_);
  advance(run.last_clock);
  end_full_steps(movement.polarity_changes_a, movement.polarity_changes_b);
  return movement.microsteps;
}

void Tmc262::end_full_steps(std::uint64_t polarity_changes_a, std::uint64_t polarity_changes_b) {
  const std::uint64_t count = polarity_changes_a + polarity_changes_b;
  if (count == 0) return;
  const bool is_enough = tmc262_choices::shows_open_load(registers_.current_scale());
  bridge_a_.note_polarity_changes(polarity_changes_a, is_enough, clock_);
  bridge_b_.note_polarity_changes(polarity_changes_b, is_enough, clock_);
  if (!bridges_on()) return;
  const auto values = stall_guard_.full_steps(count, registers_.stall_guard_and_current);
  if (values.count == 0) return;
  cool_step_.regulate(values.first, 1, registers_);
  cool_step_.regulate(values.others, values.count - 1, registers_);
}

std::int32_t Tmc262::microsteps_per_pulse() const {
  if (!has_supply_ || registers_.step_dir_off()) return 0;
  return (registers_.steps_on_both_edges() ? 2 : 1) * tmc262_choices::microsteps_per_edge(registers_.driver_control);
}

std::optional<std::uint64_t> Tmc262::shut_off_after(std::uint64_t clock) const {
  if (!bridge_a_.detects() && !bridge_b_.detects()) return std::nullopt;
  std::optional<std::uint64_t> first;
  for (const Tmc262Bridge* bridge : {&bridge_a_, &bridge_b_}) {
    const std::optional<std::uint64_t> shut_off = bridge->shut_off_clock();
    if (shut_off && *shut_off > clock && (!first || *shut_off < *first)) first = shut_off;
  }
  return first;
}

// ---- Surroundings

void Tmc262::set_enable_not(bool level) {
  enable_not_ = level;
  update_bridges();
}

void Tmc262::set_temperature(std::int32_t celsius) {
  temperature_ = celsius;
  update_bridges();
}

void Tmc262::set_supply_voltage(std::int32_t millivolts) {
  const bool had_supply = has_supply_;
  has_supply_ = millivolts >= reset_voltage;
  // The counters start when the reset ends.
  if (!has_supply_ || !had_supply) reset();
  update_bridges();
}

void Tmc262::set_coil_connected(Coil coil, bool connected) {
  bridge(coil).set_connected(connected, clock_);
}

void Tmc262::set_short_to_ground(Coil coil, bool shorted) {
  bridge(coil).set_shorted(shorted, clock_);
}

// ---- Current

Tmc262::CoilPair Tmc262::coil_currents() const {
  CoilPair wanted{};
  if (registers_.step_dir_off()) {
    const Word<CoilCurrents> word = registers_.coil_currents;
    const std::int32_t a = CoilCurrents::MagnitudeA::in(word);
    const std::int32_t b = CoilCurrents::MagnitudeB::in(word);
    wanted = {CoilCurrents::SignA::is_set(word) ? -a : a, CoilCurrents::SignB::is_set(word) ? -b : b};
  } else {
    const std::uint32_t position = sequencer_.position(clock_);
    wanted = {sine_current(position), sine_current(position + tmc262::microsteps_per_fullstep)};
  }
  const auto flowing = [this](std::int32_t current, const Tmc262Bridge& bridge) {
    return bridge.on(clock_) && bridge.connected() ? regulated(current, registers_.chopper_configuration) : 0;
  };
  return {flowing(wanted.a, bridge_a_), flowing(wanted.b, bridge_b_)};
}

/// I = CURRENT / 248 (SE + 1) / 32 V_FS / R_SENSE (chapter 9).
std::int32_t Tmc262::current_amplitude() const {
  constexpr std::int64_t table_peak = regulated_units * tmc262::coil_current_amplitude;
  constexpr std::int64_t scale_steps = tmc262::maximum_current_scale + 1;
  constexpr std::int64_t milliamperes = 1'000;  // mV / mΩ are A
  const std::int64_t peak =
      tmc262_choices::regulated_magnitude(tmc262::coil_current_amplitude, registers_.chopper_configuration);
  return static_cast<std::int32_t>(milliamperes * peak * (current_scale() + 1) * sense_voltage() /
                                   (table_peak * scale_steps * board_.sense_resistor));
}

std::int32_t Tmc262::sense_voltage() const {
  return DriverConfiguration::LowSenseVoltage::is_set(registers_.driver_configuration) ? low_sense_voltage
                                                                                       : high_sense_voltage;
}

}  // namespace opentmcl::twin
