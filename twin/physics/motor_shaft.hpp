// A motor under load, its rotor driven by the field of its coils.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "twin/physics/damped_swing.hpp"
#include "twin/physics/field.hpp"
#include "twin/physics/load.hpp"
#include "twin/physics/motor_data.hpp"
#include "twin/physics/phase_integrator.hpp"
#include "twin/physics/tick.hpp"
#include "twin/physics/torque_table.hpp"

namespace opentmcl::twin {

/// How the rotor is computed. docs/decisions/0038-regimes-of-the-motor.md has the gates between them.
enum class Regime : std::uint8_t {
  locked,    ///< the rotor follows the field: a load angle and a damped swing about it, in closed form
  free,      ///< currents and rotor are integrated in steps of 20 µs
  slipping,  ///< the field has run away from the rotor for long: integrated in steps of 40 µs
};

/// The one state is where the rotor is and how fast; regimes differ in how they take it on. Time passes only in
/// advance_to(): what a span gives depends on where it begins and ends, so spans must be cut where simulated time alone
/// says.
class MotorShaft {
 public:
  /// @param tables pull-out tables shared by all shafts of a process (lazily filled; never influence results)
  MotorShaft(const MotorData& motor, std::shared_ptr<TorqueTables> tables);

  // Conditions; they act from now() on. Setting an equal value changes nothing.
  void set_load(const Load& load) {
    if (load == load_) return;
    load_ = load;
    memory_.even = false;
    even_balance_.reset();
  }
  /// At first 24 V.
  void set_supply(double volts) {
    if (volts == supply_) return;
    supply_ = volts;
    memory_.even = false;
  }
  void set_ambient(double celsius) { ambient_ = celsius; }  ///< at first 25 °C, the winding too
  /// Integrates always: what the regimes are measured against, at two hundred times real time.
  void set_always_free(bool always) {
    always_free_ = always;
    memory_.even = false;
  }

  const MotorData& motor() const { return motor_; }
  const Load& load() const { return load_; }
  double supply() const { return supply_; }
  double ambient() const { return ambient_; }

  /// Electrical turns and turns per second of the rotor at now().
  struct State {
    double angle;
    double velocity;
  };
  Tick now() const { return memory_.now; }
  State state() const { return {memory_.rotor.angle, memory_.rotor.velocity}; }

  /// Lets time pass to `end` (> now()) under `field`, which begins at now(). Commits.
  void advance_to(Tick end, const Field& field);
  /// The state at `tick` (now() … ) under that field, without letting time pass. advance_to(end) then state() gives
  /// bit-identically what state_at(end) gave before.
  State state_at(Tick tick, const Field& field) const;

  /// Nothing moves and nothing will until field, load or supply change: the swing has died down.
  bool at_rest(const Field& field) const;
  Regime regime() const { return memory_.regime; }
  /// Longest span that advance_to() may be given in the present regime, in ticks: 100 ms locked and turning evenly,
  /// 10 ms while a swing is dying down, 2 ms locked and accelerating, 1 ms free. Multiples of 320 ticks, so that a grid
  /// of absolute ticks can be kept.
  Tick longest_span(const Field& field) const;

  /// For stallGuard2 and for display, of the span that advance_to() last let pass.
  struct Effort {
    double torque;           ///< N m of the field on the rotor
    double pull_out_torque;  ///< N m, the most it could give at this speed
    double back_emf;         ///< V, peak of each coil
  };
  Effort effort() const;
  /// What stallGuard2 of a TMC262 measures with SGT = 0; not limited to 0…1023: the chip adds SGT and limits.
  std::int32_t stall_guard_measurement() const;
  double winding_temperature() const { return memory_.winding_temperature; }  ///< °C
  /// Coil currents, A, of both coils at now() (exact in the free regime, ideal in the locked one).
  using Currents = CoilCurrents;
  Currents currents(const Field& field) const;

  /// An even motion beyond the voltage limit, where no closed form is exact enough: the lead it has settled at is
  /// measured.
  struct Cruise {
    double velocity = 0;  ///< electrical turns per second; 0: none
    double torque = 0;    ///< N m
    TorqueTables::Key conditions{};
    double least_lead = 0;  ///< electrical turns, seen since these conditions hold
    double most_lead = 0;
    Tick quiet = 0;  ///< ticks for which the lead has stayed within a narrow band

    friend bool operator==(const Cruise&, const Cruise&) = default;
  };

  /// All that time changes, for a snapshot; conditions are their owner's.
  struct Memory {
    Tick now = 0;
    PhaseState rotor;
    Regime regime = Regime::locked;
    bool even = false;                ///< it has followed an even field for a span without a swing
    Tick calm = 0;                    ///< ticks for which a free rotor has swung little
    Tick running_away = 0;            ///< ticks for which the field has been running away from it
    double winding_temperature = 25;  ///< °C
    double torque = 0;                ///< N m of the field in the last span
    double pull_out_torque = 0;       ///< N m, the most it could have given
    double amplitude = 0;             ///< A, of the field in the last span
    Cruise cruise;

    friend bool operator==(const Memory&, const Memory&) = default;
  };
  const Memory& memory() const { return memory_; }
  void restore(const Memory& memory) { memory_ = memory; }

 private:
  struct Limits;

  /// Where the rotor would stand, or turn with the field.
  struct Equilibrium {
    double lead;             ///< radians by which the field leads the rotor
    double stiffness;        ///< N m per electrical radian
    double torque;           ///< N m of the field
    double most_lead;        ///< radians, with a swing
    double pull_out_torque;  ///< N m
  };

  /// What the rotor swings about while the field turns.
  struct MovingBalance {
    Equilibrium first;  ///< when the span begins
    Equilibrium last;   ///< when it ends
    DampedOscillator oscillator;
  };

  /// Where a closed form leads to by the end of a span.
  struct Arrival {
    State rotor;
    double torque;           ///< N m of the field
    double pull_out_torque;  ///< N m
    bool is_even;            ///< there was no swing on the way, and will be none
    bool is_cruise;          ///< an even motion beyond the voltage limit goes on
  };

  void rest(const Field& field);
  void arrive(const Arrival& arrival);
  std::optional<Arrival> locked_after(Tick end, const Field& field) const;
  std::optional<Arrival> following(const Field& field, double seconds) const;
  std::optional<Arrival> settling(const Field& field, double seconds) const;
  std::optional<Arrival> cruising(const Field& field, double seconds) const;
  PhaseState integrated(Tick end, const Field& field) const;
  void take_over(const PhaseState& rotor, Tick end, const Field& field);

  double moving_torque(double angle, double velocity, double acceleration) const;
  std::optional<Equilibrium> moving_equilibrium(double angle, double velocity, double acceleration,
                                                const TorqueTable& table, const Limits& limits) const;
  std::optional<Equilibrium> standing_equilibrium(double angle, const TorqueTable& table, const Limits& limits) const;
  Cruise observed_cruise(const Field& field, Tick span, const PhaseState& rotor) const;
  bool settled(const Field& field, const Cruise& cruise) const;
  /// Nothing where the closed form is not trusted.
  std::optional<MovingBalance> moving_balance(const Field& field, double seconds, const TorqueTable& torques) const;
  std::optional<MovingBalance> remembered_balance(const Field& field, double seconds) const;
  bool keeps_its_balance(const Field& field) const { return field.acceleration == 0 && load_.spring == 0; }
  double natural_frequency(const Equilibrium& equilibrium) const;
  bool swings(double frequency) const;
  bool calm(const Field& field, double seconds, const PhaseState& rotor) const;
  bool can_lock(const Field& field) const;
  bool turns_evenly(const Field& field) const;
  bool slips() const { return memory_.regime == Regime::slipping && !always_free_; }
  PhaseState entering_free(const Field& field) const;

  double inertia() const { return motor_.rotor_inertia + load_.inertia; }
  double friction() const { return motor_.coulomb_friction + load_.coulomb_friction; }
  double drag() const { return motor_.viscous_friction + load_.viscous_friction; }
  double swing_decay() const { return (drag() + motor_.eddy_damping) / (2 * inertia()); }
  MotorConditions conditions() const;
  const TorqueTable& table(double amplitude) const;
  double pull_out_torque(double amplitude, double velocity) const;
  double standing_torque(const Field& field, double rotor_angle) const;
  double heated(double seconds, const Field& field) const;

  MotorData motor_;
  std::shared_ptr<TorqueTables> tables_;
  Load load_;
  double supply_ = 24;
  double ambient_ = 25;
  bool always_free_ = false;
  Memory memory_;

  mutable TorqueTables::Key table_key_{};  ///< of table_
  mutable std::shared_ptr<const TorqueTable> table_;

  /// A motor that turns evenly asks for the same balance again and again.
  struct EvenBalance {
    double velocity;  ///< of the field, electrical turns per second
    std::optional<MovingBalance> balance;
  };
  mutable std::optional<EvenBalance> even_balance_;  ///< nothing after a change of load or table
};

}  // namespace opentmcl::twin
