// The electrical contact of a switch, which chatters for a while after it changed.
#pragma once

#include <cstdint>

#include "twin/physics/tick.hpp"

namespace opentmcl::twin {

enum class Contact : std::uint8_t {
  normally_closed,  ///< open while the switch is held
  normally_open,    ///< closed while the switch is held
};

/// A contact is a function of the time since its last change alone: it may be looked at as often as one likes, and only
/// change() changes anything.
class BouncingContact {
 public:
  /// The time of chatter is cut into this many parts of equal length: in the first the contact has its new state, in
  /// the second the old one again, in the others one that is as good as random but the same in every run, and the last
  /// is the new one. Real ones have a few to some tens of such edges.
  static constexpr Tick parts = 16;

  /// @param bounce ticks of chatter after each change; rounded up to a multiple of `parts`
  /// @param seed contacts with different seeds chatter differently
  BouncingContact(Contact kind, Tick bounce, std::uint32_t seed)
      : kind_(kind), part_((bounce + parts - 1) / parts), seed_(seed) {}

  struct State {
    bool held = false;          ///< the switch, by the machine or by hand
    std::uint32_t changes = 0;  ///< of that, ever
    Tick changed_at = 0;        ///< the last one

    friend bool operator==(const State&, const State&) = default;
  };

  /// The switch is held or let go; nothing happens if it was so before.
  static void change(State& state, bool held, Tick tick) {
    if (held != state.held) state = {held, state.changes + 1, tick};
  }

  /// @param tick not before the last change
  bool is_open(const State& state, Tick tick) const;

  /// The least time between two changes by chatter; never_tick without bounce.
  Tick shortest_change() const { return part_ == 0 ? never_tick : part_; }

  /// The first tick after `tick` at which the chatter changes the contact; never_tick if it has come to rest.
  Tick next_change(const State& state, Tick tick) const {
    return state.changes == 0 || part_ == 0 ? never_tick : next_chatter(state, tick);
  }

 private:
  Tick next_chatter(const State& state, Tick tick) const;
  bool is_held_in_part(const State& state, Tick part) const;

  Contact kind_;
  Tick part_;  ///< length in ticks; 0 without bounce
  std::uint32_t seed_;
};

}  // namespace opentmcl::twin
