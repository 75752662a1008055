// From the ramp generator to the shaft: TMC429, TMC262 and the motor, in one time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "twin/chip/step_signal.hpp"
#include "twin/chip/tmc262.hpp"
#include "twin/chip/tmc429.hpp"
#include "twin/physics/ideal_rotor.hpp"
#include "twin/physics/motor_shaft.hpp"
#include "twin/world/field_tracker.hpp"
#include "twin/world/step_input.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl::twin {

/// What a drive train turns.
class ShaftSurroundings {
 public:
  /// The shaft is at shaft_angle() now. May set switches of the TMC429.
  virtual void shaft_turned(Tick tick) = 0;
  /// To be reported: the shaft is at shaft_angle() within a long span. Nothing may be changed.
  virtual void shaft_passes(Tick tick) = 0;
  /// How far the shaft may turn either way, in microsteps, before it reaches the next contact or end.
  virtual std::int64_t distance_to_event() const = 0;
  /// When a contact next changes although the shaft rests.
  virtual Tick next_event(Tick tick) const = 0;
  /// The shortest time in which a contact may change again after the shaft has changed it.
  virtual Tick shortest_event() const = 0;
  virtual void report(Tick tick, std::string_view signal, std::int64_t value) = 0;

 protected:
  ~ShaftSurroundings() = default;
};

/// The chips jump over time exactly, however it is cut. The motor is brought up to date at the ends of spans, and these
/// do not depend on the caller: docs/decisions/0052-spans.md says where they are.
class DriveTrain final : private StepListener {
 public:
  struct Options {
    /// Nothing: an ideal motor, whose rotor is always where the field is.
    std::optional<MotorData> motor;
    Load load;
    /// May be shared by many; own ones if empty.
    std::shared_ptr<TorqueTables> tables;
    /// An ideal rotor cannot leave these angles, in microsteps.
    IdealRotor ideal_rotor;
    /// Every step is reported, and where a motor is each 10 ms: exact pictures, slow time.
    bool reports_steps = false;
  };

  /// `surroundings` must outlive this and must not be used by this before start().
  DriveTrain(ShaftSurroundings& surroundings, Options options);
  void start() { begin_span(); }

  Tick now() const { return now_; }
  /// Lets time pass to `tick`, or to the end of the present span if that comes first. @param tick after now()
  void run(Tick tick);

  /// Rises whenever the ramp generator arrives at its target or leaves it.
  std::uint64_t arrivals() const { return arrivals_; }

  std::uint32_t transfer_tmc429(std::uint32_t datagram);
  std::uint32_t transfer_tmc262(std::uint32_t word);
  const Tmc429& tmc429() const { return *tmc429_; }
  const Tmc262& tmc262() const { return tmc262_; }

  /// Both chips are as after power-on.
  void power_cycle();

  // What the surroundings do; each from now on.
  void set_switches(bool left, bool right);
  void set_load(const Load& load);
  const Load& load() const { return load_; }
  void set_coil_connected(Tmc262::Coil coil, bool connected);
  void set_short_to_ground(Tmc262::Coil coil, bool shorted);
  /// @param voltage mV
  void set_supply_voltage(std::int32_t voltage);
  /// Of the chip. @param celsius °C
  void set_temperature(std::int32_t celsius);
  /// Of the motor. @param celsius °C
  void set_ambient_temperature(double celsius);
  void set_driver_disable(bool level);
  void set_load_measurement(std::int32_t value);
  /// A pulse on STEP that does not come from the TMC429.
  void pulse_step(bool direction);
  /// Pulses on STEP that do not come from the TMC429, from now on. @param rate as for StepInput::set_rate()
  void set_step_input_rate(double rate);
  double step_input_rate() const { return step_input_.rate(); }
  /// Whether the surroundings hear of every step from now on. Changes nothing else.
  void report_steps(bool wanted);
  /// A contact is about to chatter: what the surroundings say of their events is new.
  void expect_other_events() { commit(); }

  /// Since power-on of the world, in microsteps of 1/256 full step, rounded down.
  std::int64_t shaft_angle() const;
  /// As it was at the end of the last span.
  std::int64_t committed_shaft_angle() const;
  const std::optional<MotorShaft>& motor() const { return motor_; }
  Field field() const { return field_.until(now_, tmc429_->motion()); }

  // As it is at this very tick, also within a span. Looking changes nothing.
  /// Nothing: an ideal motor.
  std::optional<MotorShaft> present_motor() const;
  /// A field that begins now.
  Field present_field() const;

 private:
  void steps(const StepRun& run) override;
  void take_pulse(bool direction);
  void commit();
  void end_span();
  void begin_span();
  Tick end_of_span();
  Tick end_of_ideal_span();
  Tick next_event() const;
  Tick longest_ramp_span() const;
  Tick span_clear_of_events(const Field& present) const;
  bool is_clear_of_events(Tick span, const Field& present) const;
  FieldTracker::Drive drive() const;
  void after_change();
  void turn_ideal_rotor(Tick tick);
  void set_detail(bool every_step);

  ShaftSurroundings& surroundings_;
  bool reports_steps_;
  Tick now_ = 0;
  Tick powered_at_ = 0;  ///< the chips count their clocks from here
  std::optional<Tmc429> tmc429_;
  Tmc262 tmc262_;
  IdealRotor ideal_rotor_;
  std::optional<MotorShaft> motor_;
  Load load_;
  FieldTracker field_;
  StepInput step_input_;
  Tick end_of_span_ = 0;
  Tick next_report_ = never_tick;  ///< within the span
  bool watches_ramp_ = true;       ///< a change of velocity ends the span
  std::int32_t velocity_ = 0;      ///< of the ramp generator when the span began, with its fraction
  /// Between the ends of spans the firmware looks more than once in a turn.
  struct Look {
    Tick tick;
    std::int64_t angle;
  };
  mutable std::optional<Look> look_;
  bool at_target_ = true;
  std::uint64_t arrivals_ = 0;
  bool direction_ = false;
  bool left_switch_ = false;
  bool right_switch_ = false;
  bool running_ = false;                  ///< within a span or its end: the next one has not begun
  std::int32_t supply_voltage_ = 24'000;  ///< mV
};

}  // namespace opentmcl::twin
