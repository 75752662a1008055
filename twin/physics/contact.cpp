#include "twin/physics/contact.hpp"

namespace opentmcl::twin {
namespace {

/// Scatters the bits of a number over all of the result (the finalizer of splitmix64).
constexpr std::uint64_t scattered(std::uint64_t number) {
  number = (number ^ (number >> 30U)) * 0xBF58476D1CE4E5B9U;
  number = (number ^ (number >> 27U)) * 0x94D049BB133111EBU;
  return number ^ (number >> 31U);
}

}  // namespace

bool BouncingContact::is_held_in_part(const State& state, Tick part) const {
  if (part == 0 || part >= parts - 1) return state.held;
  if (part == 1) return !state.held;
  const std::uint64_t pattern = scattered((std::uint64_t{seed_} << 32U) | state.changes);
  return ((pattern >> part) & 1U) != 0;
}

bool BouncingContact::is_open(const State& state, Tick tick) const {
  // A contact that never changed has been as it is since long ago.
  const bool chatters = state.changes != 0 && part_ != 0 && tick > state.changed_at;
  const bool held = chatters ? is_held_in_part(state, (tick - state.changed_at) / part_) : state.held;
  return held == (kind_ == Contact::normally_closed);
}

Tick BouncingContact::next_chatter(const State& state, Tick tick) const {
  const Tick now = (tick - state.changed_at) / part_;
  if (now >= parts) return never_tick;
  for (Tick part = now + 1; part < parts; ++part) {
    if (is_held_in_part(state, part) != is_held_in_part(state, now)) return state.changed_at + part * part_;
  }
  return never_tick;
}

}  // namespace opentmcl::twin
