// What is on the motor's shaft: a free shaft, a linear stage or a circular axis, behind one interface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>

#include "twin/physics/circular_axis.hpp"
#include "twin/physics/contact.hpp"
#include "twin/physics/linear_stage.hpp"
#include "twin/physics/place_scale.hpp"
#include "twin/physics/rotary_axis.hpp"
#include "twin/physics/shaft.hpp"
#include "twin/physics/switch_zone.hpp"
#include "twin/physics/tick.hpp"

namespace opentmcl::twin {

using MachineDimensions = std::variant<RotaryAxisDimensions, LinearStageDimensions, CircularAxisDimensions>;

enum class MachineSwitch : std::uint8_t { left, right, home };
inline constexpr std::size_t machine_switch_count = 3;

enum class PlaceUnit : std::uint8_t { micrometre, millidegree };

/// A machine hears of the shaft in whole microsteps of 1/256 full step, which is all the truth it knows: 1/140 of a
/// degree is finer than any contact or encoder feels, and whole numbers make every edge exact and the same on every
/// machine. A rotor with an angle of its own stands in the microstep that microstep_at() gives.
///
/// Switches and backlash remember the way. Their state changes only by follow(), press() and break_wire(), and between
/// two calls of follow() the shaft is taken to have turned without turning back: call it at least where
/// next_event_distance() says. All else is looking, which changes nothing.
class Machine {
 public:
  explicit Machine(const MachineDimensions& dimensions);

  const MachineDimensions& dimensions() const { return dimensions_; }

  // ---- Changes

  /// The shaft has turned to `angle`. Ticks must not run backwards.
  /// @return whether a switch has changed
  bool follow(std::int64_t angle, Tick tick) {
    const std::int64_t before = state_.driven;
    state_.driven = driven_by(angle);
    if (quiet_.contains(state_.driven)) return false;
    update_switches(before, tick);
    return true;
  }

  /// A finger holds a switch, whatever the machine does, or leaves it again. A machine that lacks it has none to press.
  void press(MachineSwitch name, bool held, Tick tick);

  /// A broken wire is an open contact, which the pull-up of its input makes high.
  void break_wire(MachineSwitch name, bool broken) { state_.switches[index(name)].wire_broken = broken; }

  bool wire_broken(MachineSwitch name) const { return state_.switches[index(name)].wire_broken; }
  bool pressed(MachineSwitch name) const { return state_.switches[index(name)].held_by_hand; }

  // ---- Switches

  bool has_switch(MachineSwitch name) const { return switches_[index(name)].has_value(); }

  /// Whether the contact is open, as its input sees it. Where a machine lacks a switch, a wire to ground is in its
  /// place.
  /// @param tick not before the last change
  bool is_open(MachineSwitch name, Tick tick) const;

  /// The first tick after `tick` at which a contact changes by its chatter alone; never_tick if all are at rest.
  Tick next_chatter(Tick tick) const;

  /// No chatter changes a contact sooner than this many ticks after the change before; never_tick without bounce.
  Tick shortest_chatter() const;

  /// How far the shaft may turn from `angle`, where follow() last was, until a switch changes or a hard end begins or
  /// ends.
  EventDistance next_event_distance(std::int64_t angle) const;

  // ---- Place

  /// Where the slider or table stands, rounded down. Turns of a table count on.
  std::int64_t place() const { return scale_.place_at(state_.driven); }
  /// Where it would be with the shaft at `angle`.
  std::int64_t place_at(std::int64_t angle) const { return scale_.place_at(driven_by(angle)); }
  PlaceUnit place_unit() const { return place_unit_; }

  /// Angle of the driven side, behind the backlash, as a shaft angle: for an encoder that is mounted there.
  std::int64_t load_side_angle() const { return turned(state_.driven); }
  /// What it would be with the shaft at `angle`.
  std::int64_t load_side_angle_at(std::int64_t angle) const { return turned(driven_by(angle)); }

  // ---- What the motor feels, all at its shaft

  /// Shaft angles between the hard ends; without ends everything.
  const AngleRange& travel() const { return travel_; }
  /// N m/rad with which an end resists. 0 without ends.
  double end_stiffness() const { return end_stiffness_; }
  /// kg m², without the rotor's.
  double inertia() const { return inertia_; }
  /// N m, the same at every speed and against either direction.
  double friction() const { return friction_; }
  /// N m against rising shaft angles, of a load that pulls the slider or table towards falling places.
  /// @param load N on a linear stage, N m on a table or a free shaft
  double torque_of(double load) const { return load * torque_per_load_; }

  // ---- All that changes, to be saved and restored

  struct SwitchState {
    BouncingContact::State contact;
    bool held_by_machine = false;
    bool held_by_hand = false;
    bool wire_broken = false;

    friend bool operator==(const SwitchState&, const SwitchState&) = default;
  };
  struct State {
    std::int64_t driven = 0;  ///< microsteps of the driven side, rising with the place
    std::array<SwitchState, machine_switch_count> switches{};

    friend bool operator==(const State&, const State&) = default;
  };
  const State& state() const { return state_; }
  /// @param state of a machine with the same dimensions
  void restore(const State& state);

 private:
  struct Switch {
    SwitchZone zone;
    BouncingContact contact;
  };

  void build(const RotaryAxisDimensions& axis);
  void build(const LinearStageDimensions& stage);
  void build(const CircularAxisDimensions& axis);
  void add_switch(MachineSwitch name, const SwitchPlaces& places, Contact contact, std::int32_t bounce);
  void update_switches(std::int64_t before, Tick tick);
  void update_quiet_range();

  static constexpr std::size_t index(MachineSwitch name) { return static_cast<std::size_t>(name); }
  /// Between shaft angles and those that rise with the place, either way.
  std::int64_t turned(std::int64_t angle) const { return mirrored_ ? -angle : angle; }
  /// The driven side rests until the shaft has taken up the play.
  std::int64_t driven_by(std::int64_t angle) const {
    const std::int64_t driving = turned(angle);
    if (state_.driven > driving) return driving;
    return state_.driven < driving - backlash_ ? driving - backlash_ : state_.driven;
  }

  MachineDimensions dimensions_;
  PlaceScale scale_{360'000, 1, 0};
  PlaceUnit place_unit_ = PlaceUnit::millidegree;
  bool mirrored_ = false;
  std::int64_t backlash_ = 0;  ///< microsteps
  std::array<std::optional<Switch>, machine_switch_count> switches_;
  AngleRange travel_;
  double end_stiffness_ = 0.0;
  double inertia_ = 0.0;
  double friction_ = 0.0;
  double torque_per_load_ = 1.0;

  State state_;
  AngleRange quiet_;  ///< of the driven side: no switch changes while it stays within
};

}  // namespace opentmcl::twin
