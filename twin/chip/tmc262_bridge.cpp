#include "twin/chip/tmc262_bridge.hpp"

#include <algorithm>

namespace opentmcl::twin {

void Tmc262Bridge::set_conditions(const Conditions& conditions, std::uint64_t clock) {
  // The firmware writes the same registers again and again; that begins nothing.
  if (conditions == conditions_) return;
  settle(clock);
  conditions_ = conditions;
  if (!conditions_.enabled) detected_shorts_ = 0;
  begin_detection(clock);
  note_chopper_event(clock);
}

void Tmc262Bridge::reset() {
  conditions_ = {};
  detected_shorts_ = 0;
  detecting_since_.reset();
  chopped_ = false;
  open_load_ = false;
}

void Tmc262Bridge::set_connected(bool connected, std::uint64_t clock) {
  connected_ = connected;
  note_chopper_event(clock);
}

void Tmc262Bridge::set_shorted(bool shorted, std::uint64_t clock) {
  if (shorted == shorted_) return;
  settle(clock);
  shorted_ = shorted;
  begin_detection(clock);
}

void Tmc262Bridge::settle(std::uint64_t clock) {
  detected_shorts_ = detected_shorts(clock);
  detecting_since_.reset();
}

void Tmc262Bridge::begin_detection(std::uint64_t clock) {
  if (shorted_ && conditions_.watches_for_shorts && on(clock)) detecting_since_ = clock;
}

void Tmc262Bridge::note_chopper_event(std::uint64_t clock) {
  if (connected_ && on(clock)) chopped_ = true;
}

std::uint64_t Tmc262Bridge::detected_shorts_of_present(std::uint64_t clock) const {
  if (clock <= *detecting_since_) return detected_shorts_;
  const std::uint64_t cycles = (clock - *detecting_since_) / conditions_.chopper_cycle;
  return std::min(detected_shorts_ + cycles, shorts_to_shut_off);
}

void Tmc262Bridge::note_polarity_changes(std::uint64_t count, bool is_enough, std::uint64_t clock) {
  if (count == 0) return;
  if (!detecting_since_ && detected_shorts_ < shorts_to_shut_off) {
    detected_shorts_ -= std::min(detected_shorts_, count);
  }
  const bool is_on = on(clock);
  if (is_on && is_enough) open_load_ = count == 1 ? !chopped_ : !connected_;
  chopped_ = is_on && connected_;
}

}  // namespace opentmcl::twin
