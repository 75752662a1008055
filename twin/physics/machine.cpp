#include "twin/physics/machine.hpp"

#include <algorithm>
#include <utility>

namespace opentmcl::twin {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double metres_per_micrometre = 1e-6;
constexpr std::int64_t millidegrees_per_turn = 360'000;

}  // namespace

Machine::Machine(const MachineDimensions& dimensions) : dimensions_(dimensions) {
  std::visit([this](const auto& kind) { build(kind); }, dimensions_);
  for (std::size_t i = 0; i < machine_switch_count; ++i) {
    if (!switches_[i]) continue;
    const bool held = switches_[i]->zone.presses_at(state_.driven);
    state_.switches[i].held_by_machine = held;
    state_.switches[i].contact.held = held;
  }
  update_quiet_range();
}

void Machine::build(const RotaryAxisDimensions& axis) {
  inertia_ = axis.inertia;
  friction_ = axis.friction;
}

void Machine::build(const LinearStageDimensions& stage) {
  scale_ = PlaceScale(stage.pitch, 1, stage.start);
  place_unit_ = PlaceUnit::micrometre;
  mirrored_ = stage.mirrored;
  backlash_ = scale_.angle_of(stage.backlash);

  const std::int64_t end = stage.travel / 2;
  const std::int64_t begin_of_switch = end - stage.limit_switch_distance;
  const std::int64_t end_of_switch = begin_of_switch + stage.limit_switch_width;
  const std::int64_t home = stage.home_switch_center;
  const std::int64_t home_half = stage.home_switch_width / 2;
  const auto add = [this, &stage](MachineSwitch name, std::int64_t from, std::int64_t to) {
    add_switch(name, {from, to, stage.switch_hysteresis, 0}, stage.contact, stage.switch_bounce);
  };
  add(MachineSwitch::left, -end_of_switch, -begin_of_switch);
  add(MachineSwitch::right, begin_of_switch, end_of_switch);
  add(MachineSwitch::home, home - home_half, home + home_half);

  // The slider comes to its right end when the play has been taken up.
  const std::int64_t lowest = scale_.first_angle_at(-end);
  const std::int64_t highest = scale_.last_angle_at(end) + backlash_;
  travel_ = mirrored_ ? AngleRange{-highest, -lowest} : AngleRange{lowest, highest};

  // A screw turns rad into m by its lead, pitch / 2π: a force F takes the torque F·lead, a mass m has the inertia
  // m·lead², and a spring of k N/m is one of k·lead² N m/rad. Its losses are part of the friction.
  const double lead = stage.pitch * metres_per_micrometre / (2.0 * pi);
  inertia_ = stage.screw_inertia + stage.moved_mass * lead * lead;
  friction_ = stage.friction * lead;
  end_stiffness_ = stage.end_stiffness * lead * lead;
  torque_per_load_ = mirrored_ ? -lead : lead;
}

void Machine::build(const CircularAxisDimensions& axis) {
  scale_ = PlaceScale(millidegrees_per_turn * axis.gear_denominator, axis.gear_numerator, axis.start);
  mirrored_ = axis.mirrored;
  backlash_ = scale_.angle_of(axis.backlash);
  const std::int64_t half = axis.home_mark_width / 2;
  add_switch(
      MachineSwitch::home,
      {axis.home_mark_center - half, axis.home_mark_center + half, axis.switch_hysteresis, millidegrees_per_turn},
      axis.contact, axis.switch_bounce);

  // Behind a gear of ratio r the shaft feels a torque T as T/r and an inertia J as J/r².
  const double ratio = static_cast<double>(axis.gear_numerator) / axis.gear_denominator;
  inertia_ = axis.gear_inertia + axis.table_inertia / (ratio * ratio);
  friction_ = axis.friction / ratio;
  torque_per_load_ = (mirrored_ ? -1.0 : 1.0) / ratio;
}

void Machine::add_switch(MachineSwitch name, const SwitchPlaces& places, Contact contact, std::int32_t bounce) {
  const Tick ticks = static_cast<Tick>(bounce) * ticks_per_microsecond;
  const auto seed = static_cast<std::uint32_t>(index(name));
  switches_[index(name)].emplace(Switch{SwitchZone(places, scale_), BouncingContact(contact, ticks, seed)});
}

void Machine::update_switches(std::int64_t before, Tick tick) {
  for (std::size_t i = 0; i < machine_switch_count; ++i) {
    if (!switches_[i]) continue;
    SwitchState& state = state_.switches[i];
    state.held_by_machine = switches_[i]->zone.holds_after(state.held_by_machine, before, state_.driven);
    BouncingContact::change(state.contact, state.held_by_machine || state.held_by_hand, tick);
  }
  update_quiet_range();
}

void Machine::update_quiet_range() {
  quiet_ = {};
  for (std::size_t i = 0; i < machine_switch_count; ++i) {
    if (!switches_[i]) continue;
    const EventDistance change = switches_[i]->zone.next_change(state_.switches[i].held_by_machine, state_.driven);
    if (change.down != EventDistance::never) quiet_.lowest = std::max(quiet_.lowest, state_.driven - change.down + 1);
    if (change.up != EventDistance::never) quiet_.highest = std::min(quiet_.highest, state_.driven + change.up - 1);
  }
}

void Machine::press(MachineSwitch name, bool held, Tick tick) {
  if (!switches_[index(name)]) return;
  SwitchState& state = state_.switches[index(name)];
  state.held_by_hand = held;
  BouncingContact::change(state.contact, state.held_by_machine || state.held_by_hand, tick);
}

bool Machine::is_open(MachineSwitch name, Tick tick) const {
  const SwitchState& state = state_.switches[index(name)];
  if (state.wire_broken) return true;
  const std::optional<Switch>& found = switches_[index(name)];
  return found && found->contact.is_open(state.contact, tick);
}

Tick Machine::shortest_chatter() const {
  Tick shortest = never_tick;
  for (const std::optional<Switch>& mounted : switches_) {
    if (mounted) shortest = std::min(shortest, mounted->contact.shortest_change());
  }
  return shortest;
}

Tick Machine::next_chatter(Tick tick) const {
  Tick next = never_tick;
  for (std::size_t i = 0; i < machine_switch_count; ++i) {
    if (switches_[i]) next = std::min(next, switches_[i]->contact.next_change(state_.switches[i].contact, tick));
  }
  return next;
}

EventDistance Machine::next_event_distance(std::int64_t angle) const {
  EventDistance distance;
  // Falling, the driven side stands where the shaft does as soon as that comes down to it; rising, behind by the play.
  const std::int64_t driving = turned(angle);
  if (quiet_.lowest != AngleRange::below_all) distance.down = driving - quiet_.lowest + 1;
  if (quiet_.highest != AngleRange::above_all) distance.up = quiet_.highest + backlash_ + 1 - driving;
  if (mirrored_) std::swap(distance.down, distance.up);
  if (travel_ == AngleRange{}) return distance;

  EventDistance ends;
  if (angle < travel_.highest) ends.up = (angle < travel_.lowest ? travel_.lowest : travel_.highest) - angle;
  if (angle > travel_.lowest) ends.down = angle - (angle > travel_.highest ? travel_.highest : travel_.lowest);
  return nearer_of(distance, ends);
}

void Machine::restore(const State& state) {
  state_ = state;
  update_quiet_range();
}

}  // namespace opentmcl::twin
