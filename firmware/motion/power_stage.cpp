#include "firmware/motion/power_stage.hpp"

namespace opentmcl {

using tmc262::StallGuardAndCurrent;

namespace {

/// What a value of parameter 254 means (PD-1161 manual, chapter 4).
struct CurrentSwitching {
  bool follows_motion;          ///< run current while steps come, then standby, then freewheeling
  bool enable_selects_current;  ///< the ENABLE input chooses between run and standby current
  bool enable_switches_driver;  ///< without ENABLE there is no current at all
};

constexpr CurrentSwitching current_switching[] = {
    {true, false, false},  {false, true, false}, {true, false, false},
    {false, false, false}, {true, false, true},  {false, false, true},
};

/// The TMCM-1110's only step/direction mode reduces the current by itself, like mode 2 of the PD-1161.
constexpr std::int32_t automatic_step_direction_mode = 2;

constexpr const CurrentSwitching& switching_of(ModuleId module, std::int32_t mode) {
  return current_switching[module == ModuleId::tmcm1110 && mode != 0 ? automatic_step_direction_mode : mode];
}

/// The driver calls it standstill when no step came for 2^20 of its clocks of 62.5 ns.
constexpr Microseconds standstill_time = tmc262::standstill_clocks / 16;

constexpr Microseconds ten_milliseconds(std::int32_t count) {
  return static_cast<Microseconds>(count) * 10 * one_millisecond;
}

}  // namespace

void PowerStage::initialise() {
  power_ = Power::run;
  at_rest_ = false;
  current_source_ = AxisParameter::maximum_current;
  state_ = {settings_[current_source_], false, true};
  apply_driver_settings(settings_, state_, tmc262_);
  tmc262_.send_all();
}

void PowerStage::apply(AxisParameter parameter) {
  switch (parameter) {
    case AxisParameter::maximum_current:
    case AxisParameter::standby_current:
    case AxisParameter::boost_current:
    case AxisParameter::smart_energy_slow_run_current:
      send_current();
      break;
    default:
      send_changes();
      break;
  }
}

void PowerStage::send_current() {
  state_.current = settings_[current_source_];
  const auto word =
      StallGuardAndCurrent::CurrentScale::replaced(tmc262_.stall_guard_and_current, current_scale_of(state_.current));
  if (word == tmc262_.stall_guard_and_current) return;
  tmc262_.stall_guard_and_current = word;
  tmc262_.send(word);
}

void PowerStage::send_changes() {
  const auto before = tmc262_;
  apply_driver_settings(settings_, state_, tmc262_);
  if (!(tmc262_.driver_control == before.driver_control)) tmc262_.send(tmc262_.driver_control);
  if (!(tmc262_.chopper_configuration == before.chopper_configuration)) tmc262_.send(tmc262_.chopper_configuration);
  // coolStep begins at the current that is in force when it is switched on.
  if (!(tmc262_.stall_guard_and_current == before.stall_guard_and_current)) {
    tmc262_.send(tmc262_.stall_guard_and_current);
  }
  if (!(tmc262_.cool_step_control == before.cool_step_control)) tmc262_.send(tmc262_.cool_step_control);
  if (!(tmc262_.driver_configuration == before.driver_configuration)) tmc262_.send(tmc262_.driver_configuration);
}

void PowerStage::energise() {
  // With steps from outside it is the steps or the ENABLE input that decide.
  if (takes_external_steps()) return;
  // While the motor stood nobody looked whether the driver has kept its registers.
  if (at_rest_) tmc262_.send_all();
  at_rest_ = false;
  if (power_ == Power::run) return;
  constexpr RampState about_to_accelerate{.target_velocity = 1, .at_rest = false};
  set(Power::run, about_to_accelerate);
}

Microseconds PowerStage::follow(const RampState& ramp, bool enable, Microseconds now) {
  const CurrentSwitching& switching = switching_of(module_, settings_[AxisParameter::step_direction_mode]);
  Power power = Power::run;
  Microseconds due = never;
  const bool steps_rest = !takes_external_steps() || tmc262::Reply::Standstill::is_set(tmc262_.refresh());
  if (switching.follows_motion) {
    const bool at_rest = ramp.at_rest || (ramp.held_by_switch && settings_[AxisParameter::end_switch_power_down] != 0);
    due = follow_rest(at_rest && steps_rest, now, power);
  } else if (switching.enable_selects_current && !enable) {
    power = Power::standby;
  }
  if (switching.enable_switches_driver && !enable) power = Power::off;
  set(power, ramp);
  // Steps and ENABLE come from outside: there is no command to wait for.
  return takes_external_steps() ? now + period : due;
}

/// @param power run, or after the delays at rest standby (214) and off (204)
Microseconds PowerStage::follow_rest(bool at_rest, Microseconds now, Power& power) {
  const bool begins = at_rest && !at_rest_;
  at_rest_ = at_rest;
  if (!at_rest) return now + period;
  if (begins) {
    // Standstill of external steps is known late.
    const Microseconds known_late = takes_external_steps() && now >= standstill_time ? standstill_time : 0;
    at_rest_since_ = now - known_late;
  }
  const Microseconds rested = now - at_rest_since_;
  const std::int32_t freewheeling = settings_[AxisParameter::freewheeling_delay];
  const Microseconds standby_after = ten_milliseconds(settings_[AxisParameter::power_down_delay]);
  const Microseconds off_after = freewheeling == 0 ? never : ten_milliseconds(freewheeling);
  if (rested >= off_after) {
    power = Power::off;
    return never;
  }
  const bool stands_by = rested >= standby_after;
  if (stands_by) power = Power::standby;
  const Microseconds next = !stands_by && standby_after < off_after ? standby_after : off_after;
  return next == never ? never : at_rest_since_ + next;
}

void PowerStage::set(Power power, const RampState& ramp) {
  power_ = power;
  // Speeds are those of the ramp generator: of steps from outside none is known, so they count as fast.
  const bool is_fast = takes_external_steps() || ramp.speed() >= settings_[AxisParameter::smart_energy_threshold_speed];
  AxisParameter source = AxisParameter::standby_current;
  if (power == Power::run) {
    if (ramp.is_accelerating() && settings_[AxisParameter::boost_current] != 0) {
      source = AxisParameter::boost_current;
    } else {
      source = is_fast ? AxisParameter::maximum_current : AxisParameter::smart_energy_slow_run_current;
    }
  }
  current_source_ = source;
  const bool cool_step = power == Power::run && is_fast;
  const bool bridges_on = power != Power::off;
  if (cool_step != state_.cool_step || bridges_on != state_.bridges_on) {
    state_ = {settings_[source], cool_step, bridges_on};
    send_changes();
  } else {
    send_current();
  }
}

std::int32_t PowerStage::load_value() {
  return tmc262::Reply::StallGuardValue::in(tmc262_.reply(tmc262::ReplyFormat::stall_guard));
}

std::int32_t PowerStage::actual_current_scale() {
  return tmc262::Reply::CurrentScale::in(tmc262_.reply(tmc262::ReplyFormat::stall_guard_and_current));
}

std::int32_t PowerStage::flags() {
  return tmc262::Reply::Flags::in(tmc262_.refresh());
}

bool PowerStage::is_shut_down() {
  using tmc262::Reply;
  return (tmc262_.refresh().bits &
          (Reply::Overtemperature::mask | Reply::ShortToGroundA::mask | Reply::ShortToGroundB::mask)) != 0;
}

}  // namespace opentmcl
