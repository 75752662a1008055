#include "twin/world/drive_train.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/chip/microstep_table.hpp"
#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {
namespace {

constexpr unsigned driven_motor = 0;  // motor 1: the only one with a driver on these modules

constexpr double electrical_turn = tmc262::microstep_positions;

/// Where an even motion may bring the shaft to a contact or an end before long, it is brought up to date this often.
constexpr Tick short_span = 10 * ticks_per_millisecond;
/// Near a contact or an end, this often: 40 us.
constexpr Tick finest_span = 640;
/// One that is moved by single steps, this often.
constexpr Tick single_step_span = ticks_per_millisecond;
/// While a ramp changes its velocity, as often as it needs.
constexpr Tick ramp_spans[] = {2 * ticks_per_millisecond, ticks_per_millisecond, ticks_per_millisecond / 2,
                               ticks_per_millisecond / 10, finest_span};
constexpr Tick shortest_ramp_span = 320;  // one step of the integrator
/// So many microsteps the field may be elsewhere than the ramp generator has it, for a mean acceleration is told to the
/// motor.
constexpr double ramp_tolerance = 2;

/// A motor that turns is reported this often.
constexpr Tick report_period = short_span;

/// Less than this, and an ideal motor's steps are taken one by one: 1 ms.
constexpr Tick shortest_jump = 1000 * ticks_per_microsecond;

/// A rotor that is locked to the field swings about it by less than a full step; one that is not is moved by the field
/// by no more than two within a span.
constexpr double swing = 2 * tmc262::microsteps_per_fullstep;

/// Steps of more than 1/16 full step are single jumps to the motor, unless microPlyer divides them.
constexpr std::int32_t coarsest_smooth_step = tmc262::microsteps_per_fullstep / 16;

constexpr double milliamperes = 1000;  // in 1 A
constexpr double millivolts = 1000;    // in 1 V

constexpr Tick next_multiple(Tick period, Tick now) {
  return (now / period + 1) * period;
}

bool is_write(std::uint32_t datagram) {
  return !tmc429::Datagram::Read::is_set({datagram});
}

/// By which the field moves while the motion controller makes one step, negative with DIR inverted.
double microsteps_a_step(const Tmc429& motion_controller, std::int32_t microsteps_a_pulse) {
  using tmc429::InterfaceConfiguration;
  const auto configuration = motion_controller.interface_configuration();
  const double pulses = InterfaceConfiguration::StepOnBothEdges::is_set(configuration) ? 0.5 : 1.0;
  return InterfaceConfiguration::InvertDirection::is_set(configuration) ? -pulses * microsteps_a_pulse
                                                                        : pulses * microsteps_a_pulse;
}

bool spi_sets_currents(const Tmc262& chip) {
  return tmc262::DriverConfiguration::StepDirOff::is_set(chip.driver_configuration());
}

/// Of the vector of both currents, in units of a sine's peak.
double magnitude_of(Tmc262::CoilPair currents) {
  const double a = currents.a;
  const double b = currents.b;
  return std::sqrt(a * a + b * b) / tmc262::coil_current_amplitude;
}

/// Where the field is within a turn. Currents from SPI make a field in the direction of their vector.
std::uint32_t field_position(const Tmc262& chip) {
  if (!spi_sets_currents(chip)) return chip.microstep_position();
  const Tmc262::CoilPair currents = chip.coil_currents();
  std::uint32_t nearest = 0;
  std::int32_t best = std::numeric_limits<std::int32_t>::min();
  for (std::uint32_t position = 0; position < tmc262::microstep_positions; ++position) {
    const std::int32_t agreement =
        currents.a * sine_current(position) + currents.b * sine_current(position + tmc262::microsteps_per_fullstep);
    if (agreement > best) {
      best = agreement;
      nearest = position;
    }
  }
  return nearest;
}

}  // namespace

DriveTrain::DriveTrain(ShaftSurroundings& surroundings, Options options)
    : surroundings_(surroundings),
      reports_steps_(options.reports_steps),
      ideal_rotor_(options.ideal_rotor),
      load_(options.load) {
  tmc429_.emplace(static_cast<StepListener&>(*this));
  if (!options.motor) return;
  motor_.emplace(*options.motor, options.tables ? options.tables : std::make_shared<TorqueTables>());
  motor_->set_load(load_);
  motor_->set_supply(supply_voltage_ / millivolts);
}

void DriveTrain::run(Tick tick) {
  const Tick end = std::min({tick, end_of_span_, next_report_, step_input_.next()});
  running_ = true;
  if (watches_ramp_) {
    tmc429_->advance_until_change(end - now_, driven_motor);
  } else {
    tmc429_->advance(end - now_);
  }
  running_ = false;
  now_ = powered_at_ + tmc429_->clock();
  tmc262_.advance(tmc429_->clock());
  const bool is_new_motion = watches_ramp_ && tmc429_->motion(driven_motor).velocity_with_fraction != velocity_;
  if (now_ == step_input_.next()) {
    step_input_.take();
    take_pulse(step_input_.direction());
  }
  if (is_new_motion || now_ == end_of_span_) {
    commit();
  } else if (now_ == next_report_) {
    surroundings_.shaft_passes(now_);
    next_report_ += report_period;
  }
}

/// Brings the motor up to the present under the conditions with which the span began.
void DriveTrain::end_span() {
  if (motor_ && now_ > field_.begun()) {
    motor_->advance_to(now_, field());
    tmc262_.set_load_measurement(motor_->stall_guard_measurement());
  }
  running_ = true;
  surroundings_.shaft_turned(now_);
  running_ = false;
}

void DriveTrain::commit() {
  end_span();
  begin_span();
}

void DriveTrain::begin_span() {
  if (tmc429_->at_target(driven_motor) != at_target_) {
    at_target_ = !at_target_;
    ++arrivals_;
  }
  const Tmc429::Motion motion = tmc429_->motion(driven_motor);
  velocity_ = motion.velocity_with_fraction;
  field_.begin(now_, drive(), motion, step_input_.part_of_step(now_));
  look_.reset();
  watches_ramp_ = !tmc429_->changes_velocity(driven_motor);
  end_of_span_ = motor_ ? end_of_span() : end_of_ideal_span();
}

/// A point of the grid on which the motor is brought up to date.
Tick DriveTrain::end_of_span() {
  set_detail(field_.drive().is_coarse || tmc262_.interpolates());
  const Tick end = next_event();
  next_report_ = never_tick;
  const Field present = field();
  const bool steps_may_come = step_input_.rate() != 0 || tmc429_->clocks_for_steps(1, driven_motor) != never_tick;
  if (!steps_may_come && motor_->at_rest(present)) return end;
  if (reports_steps_) next_report_ = next_multiple(report_period, now_);
  return std::min(end, next_multiple(span_clear_of_events(present), now_));
}

/// The longest one in which the motor need not be brought up to date.
Tick DriveTrain::span_clear_of_events(const Field& present) const {
  // That of single steps stands still as far as is known now.
  const Tick longest =
      field_.drive().is_coarse ? single_step_span : std::min(motor_->longest_span(present), longest_ramp_span());
  if (is_clear_of_events(longest, present)) return longest;
  return longest > short_span && is_clear_of_events(short_span, present) ? short_span : finest_span;
}

/// The longest one over which the mean acceleration of the field is as good as the one that it has: it may begin to
/// cruise or to brake within the span, and turn round.
Tick DriveTrain::longest_ramp_span() const {
  if (watches_ramp_) return never_tick;
  const Tmc429::Motion motion = tmc429_->motion(driven_motor);
  for (const Tick span : ramp_spans) {
    const double change = field_.velocity_of(tmc429_->greatest_change(span, driven_motor), motion.pulse_divider);
    // With the same velocity at both ends, the one half accelerated and the other braked: x = a T²/4
    const double error = std::fabs(change) * seconds_of(span) / 4;
    if (error * electrical_turn <= ramp_tolerance) return span;
  }
  return shortest_ramp_span;
}

/// Whether nothing can bring the shaft to a contact or an end within a span.
bool DriveTrain::is_clear_of_events(Tick span, const Field& present) const {
  const double seconds = static_cast<double>(span) * seconds_per_tick;
  const double field_way = std::fabs(present.velocity) * seconds * electrical_turn;
  const double rotor_way = std::fabs(motor_->state().velocity) * seconds * electrical_turn;
  // A ramp moves it by little more: its spans are chosen so.
  const double reach = 1.5 * std::max(field_way, rotor_way) + swing;
  return static_cast<double>(surroundings_.distance_to_event()) > reach;
}

/// An ideal rotor follows each run of steps at once. Where one of them may change a switch, they come one by one.
Tick DriveTrain::end_of_ideal_span() {
  const double step = std::max(std::fabs(field_.drive().microsteps_a_step), 1.0);
  const std::int64_t distance = std::min(surroundings_.distance_to_event(), ideal_rotor_.distance_to_end());
  const auto free_steps = static_cast<std::uint64_t>(static_cast<double>(distance) / step);
  const Tick clear = free_steps == 0 ? 0 : tmc429_->clocks_for_steps(free_steps, driven_motor);
  set_detail(clear < shortest_jump || tmc262_.interpolates());
  const Tick span = clear < shortest_jump ? std::min(shortest_jump, surroundings_.shortest_event()) : clear;
  return span < never_tick - now_ ? std::min(next_event(), now_ + span) : next_event();
}

/// The next tick at which something changes by itself.
Tick DriveTrain::next_event() const {
  Tick next = surroundings_.next_event(now_);
  if (const auto shut_off = tmc262_.next_shut_off()) next = std::min(next, powered_at_ + *shut_off);
  return next;
}

void DriveTrain::set_detail(bool every_step) {
  tmc429_->set_detail(every_step || reports_steps_ ? StepDetail::edges : StepDetail::runs);
}

void DriveTrain::report_steps(bool wanted) {
  reports_steps_ = wanted;
  // A span in which single steps are told for nothing does no harm; the next one begins without them.
  if (wanted) tmc429_->set_detail(StepDetail::edges);
  next_report_ = wanted && motor_ ? next_multiple(report_period, now_) : never_tick;
}

FieldTracker::Drive DriveTrain::drive() const {
  using Coil = Tmc262::Coil;
  const bool bridge_a_on = tmc262_.bridge_on(Coil::a);
  const bool bridge_b_on = tmc262_.bridge_on(Coil::b);
  double amplitude = tmc262_.current_amplitude() / milliamperes;
  if (spi_sets_currents(tmc262_)) amplitude *= magnitude_of(tmc262_.coil_currents());
  const std::int32_t microsteps_a_pulse = tmc262_.microsteps_per_pulse();
  return {.amplitude = amplitude,
          .energised = bridge_a_on || bridge_b_on,
          .coil_a_connected = bridge_a_on && tmc262_.coil_connected(Coil::a),
          .coil_b_connected = bridge_b_on && tmc262_.coil_connected(Coil::b),
          .microsteps_a_step = microsteps_a_step(*tmc429_, microsteps_a_pulse),
          .other_steps_per_second = step_input_.rate(),
          .microsteps_an_other_step = static_cast<double>(microsteps_a_pulse),
          .is_coarse = microsteps_a_pulse > coarsest_smooth_step && !tmc262_.interpolates()};
}

/// Something was done to the driver: what that is to the motor acts from now on.
void DriveTrain::after_change() {
  field_.jump_to(field_position(tmc262_), now_);
  if (motor_) {
    if (!(field_.drive() == drive())) commit();
  } else {
    turn_ideal_rotor(now_);
    begin_span();
  }
}

std::uint32_t DriveTrain::transfer_tmc429(std::uint32_t datagram) {
  if (!is_write(datagram)) return tmc429_->transfer(datagram);
  // The motion up to now is that of the registers before.
  end_span();
  const std::uint32_t reply = tmc429_->transfer(datagram);
  begin_span();
  return reply;
}

std::uint32_t DriveTrain::transfer_tmc262(std::uint32_t word) {
  const std::uint32_t reply = tmc262_.transfer(word, now_ - powered_at_);
  after_change();
  return reply;
}

void DriveTrain::power_cycle() {
  commit();
  powered_at_ = now_;
  tmc429_.emplace(static_cast<StepListener&>(*this));
  tmc429_->set_left_switch(left_switch_);
  tmc429_->set_right_switch(right_switch_);
  tmc262_.power_up();
  direction_ = false;
  after_change();
  begin_span();
}

void DriveTrain::set_switches(bool left, bool right) {
  left_switch_ = left;
  right_switch_ = right;
  // From within a step or the end of a span, the next span has not begun.
  const bool is_from_outside = !running_;
  if (is_from_outside) end_span();
  tmc429_->set_left_switch(left);
  tmc429_->set_right_switch(right);
  if (is_from_outside) begin_span();
}

void DriveTrain::set_load(const Load& load) {
  if (load == load_) return;
  end_span();
  load_ = load;
  if (motor_) motor_->set_load(load);
  begin_span();
}

void DriveTrain::set_supply_voltage(std::int32_t voltage) {
  commit();
  supply_voltage_ = voltage;
  if (motor_) motor_->set_supply(voltage / millivolts);
  tmc262_.set_supply_voltage(voltage);
  after_change();
  begin_span();
}

void DriveTrain::set_coil_connected(Tmc262::Coil coil, bool connected) {
  tmc262_.set_coil_connected(coil, connected);
  after_change();
}

void DriveTrain::set_short_to_ground(Tmc262::Coil coil, bool shorted) {
  // The motor comes up to date under the conditions before: the short changes when the span has to end.
  commit();
  tmc262_.set_short_to_ground(coil, shorted);
  after_change();
  begin_span();
}

void DriveTrain::set_temperature(std::int32_t celsius) {
  tmc262_.set_temperature(celsius);
  after_change();
}

void DriveTrain::set_ambient_temperature(double celsius) {
  if (!motor_ || motor_->ambient() == celsius) return;
  end_span();
  motor_->set_ambient(celsius);
  begin_span();
}

void DriveTrain::set_driver_disable(bool level) {
  tmc262_.set_enable_not(level);
  after_change();
}

void DriveTrain::set_load_measurement(std::int32_t value) {
  tmc262_.set_load_measurement(value);
}

void DriveTrain::pulse_step(bool direction) {
  end_span();
  take_pulse(direction);
  begin_span();
}

void DriveTrain::take_pulse(bool direction) {
  const std::uint64_t clock = now_ - powered_at_;
  steps({driven_motor, 1, clock, clock, StepSignal::pulse, direction});
}

void DriveTrain::set_step_input_rate(double rate) {
  if (rate == step_input_.rate()) return;
  end_span();
  step_input_.set_rate(rate, now_);
  begin_span();
}

void DriveTrain::steps(const StepRun& run) {
  if (run.motor != driven_motor) return;
  const Tick tick = powered_at_ + run.last_clock;
  if (reports_steps_) {
    if (run.direction != direction_) surroundings_.report(tick, "direction", run.direction);
    if (run.signal != StepSignal::falling) surroundings_.report(tick, "step", 1);
    if (run.signal != StepSignal::rising) surroundings_.report(tick, "step", 0);
  }
  direction_ = run.direction;
  const std::int64_t moved = tmc262_.steps(run.count, run.signal, run.direction, run.first_clock, run.last_clock);
  field_.move(moved, tick);
  if (motor_) return;
  if (run.count == 1) {
    turn_ideal_rotor(tick);
  } else if (tmc262_.bridges_on()) {
    ideal_rotor_.turn(moved);
    surroundings_.shaft_turned(tick);
  }
}

void DriveTrain::turn_ideal_rotor(Tick tick) {
  if (motor_ || !tmc262_.bridges_on() || spi_sets_currents(tmc262_)) return;
  const std::int64_t before = ideal_rotor_.angle();
  ideal_rotor_.follow(tmc262_.microstep_position());
  if (ideal_rotor_.angle() != before) surroundings_.shaft_turned(tick);
}

std::optional<MotorShaft> DriveTrain::present_motor() const {
  std::optional<MotorShaft> present = motor_;
  if (present && present->now() < now_) present->advance_to(now_, field());
  return present;
}

Field DriveTrain::present_field() const {
  Field present = field();
  if (!motor_) {
    // An ideal rotor follows each run of steps, so nobody asks how the field has moved since the span began.
    present.angle = electrical_turns_at(field_.position());
  } else if (!present.steps.empty()) {
    present.angle = present.steps.back().angle;
  } else {
    const double seconds = static_cast<double>(now_ - field_.begun()) * seconds_per_tick;
    present.angle = present.angle_after(seconds);
    present.velocity = present.velocity_after(seconds);
  }
  present.steps = {};
  return present;
}

std::int64_t DriveTrain::shaft_angle() const {
  if (!motor_ || motor_->now() == now_) return committed_shaft_angle();
  if (!look_ || look_->tick != now_) look_ = {now_, microstep_at(motor_->state_at(now_, field()).angle)};
  return look_->angle;
}

std::int64_t DriveTrain::committed_shaft_angle() const {
  if (!motor_) return ideal_rotor_.angle();
  return microstep_at(motor_->state().angle);
}

}  // namespace opentmcl::twin
