// One of the two full bridges of the TMC262 with the protection that watches it (datasheet chapter 12).
#pragma once

#include <cstdint>
#include <optional>

namespace opentmcl::twin {

class Tmc262Bridge {
 public:
  /// What the rest of the chip says.
  struct Conditions {
    bool enabled = false;             ///< ENN is low and TOFF is not 0
    bool too_hot = false;             ///< over-temperature
    bool watches_for_shorts = true;   ///< DISS2G = 0
    std::uint64_t chopper_cycle = 1;  ///< in clocks

    friend bool operator==(const Conditions&, const Conditions&) = default;
  };

  void set_conditions(const Conditions& conditions, std::uint64_t clock);
  /// Forgets what it has detected, as the logic loses its supply.
  void reset();
  /// The coil: false when a wire is broken.
  void set_connected(bool connected, std::uint64_t clock);
  /// One of its ends touches ground.
  void set_shorted(bool shorted, std::uint64_t clock);

  /// The current has changed its polarity `count` times until `clock`. @param is_enough for an open load to be told
  void note_polarity_changes(std::uint64_t count, bool is_enough, std::uint64_t clock);

  /// A current can flow, where a coil is connected.
  bool on(std::uint64_t clock) const { return conditions_.enabled && !conditions_.too_hot && !shut_off(clock); }
  bool connected() const { return connected_; }
  bool shorted() const { return shorted_; }
  /// S2GA or S2GB: the third detected short has shut it off.
  bool shut_off(std::uint64_t clock) const { return detected_shorts(clock) >= shorts_to_shut_off; }
  /// A short is being counted.
  bool detects() const { return detecting_since_.has_value(); }
  /// When a short that lasts will shut it off, if it will.
  std::optional<std::uint64_t> shut_off_clock() const {
    if (!detecting_since_) return std::nullopt;
    return *detecting_since_ + (shorts_to_shut_off - detected_shorts_) * conditions_.chopper_cycle;
  }
  /// OLA or OLB.
  bool open_load() const { return open_load_; }

  friend bool operator==(const Tmc262Bridge&, const Tmc262Bridge&) = default;

 private:
  static constexpr std::uint64_t shorts_to_shut_off = 3;

  std::uint64_t detected_shorts(std::uint64_t clock) const {
    return detects() ? detected_shorts_of_present(clock) : detected_shorts_;
  }
  std::uint64_t detected_shorts_of_present(std::uint64_t clock) const;
  /// Call it after any change of what it depends on, having settled what was detected before.
  void begin_detection(std::uint64_t clock);
  void settle(std::uint64_t clock);
  void note_chopper_event(std::uint64_t clock);

  Conditions conditions_;
  bool connected_ = true;
  bool shorted_ = false;
  std::uint64_t detected_shorts_ = 0;             ///< before the detection that is going on
  std::optional<std::uint64_t> detecting_since_;  ///< one short per chopper cycle from here
  bool chopped_ = false;                          ///< a chopper event came since the last polarity change
  bool open_load_ = false;
};

}  // namespace opentmcl::twin
