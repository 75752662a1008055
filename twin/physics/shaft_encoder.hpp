// An encoder that turns with the motor's shaft or with what is behind it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {

/// How an encoder is made and mounted. The default is the one of the TMCM-1110's machine (docs/machine.md).
struct EncoderProperties {
  enum class Kind : std::uint8_t {
    absolute,     ///< sensOstep in the PD-1161: 1024 angles a turn; knows its angle at power-on, but not the turns
    incremental,  ///< channels A, B and N; counts four in a line, from 0 at power-on
  };

  Kind kind = Kind::incremental;
  bool on_load_side = false;  ///< behind the backlash, not on the motor's shaft
  bool reversed = false;      ///< counts down when the shaft angle rises

  // ---- Incremental

  std::int32_t lines = 256;        ///< a turn, 1 and more
  std::int32_t null_position = 0;  ///< counts, 0 to a turn, where N begins to have its null level; 0 is shaft angle 0
  std::int32_t null_width = 1;     ///< counts for which it does, less than a turn
  bool null_level = false;         ///< of N there; elsewhere it has the other one

  // ---- Absolute: the magnet on the shaft's end, in microsteps (51200 a turn)

  std::int32_t magnet_offset = 0;  ///< of its angle 0, which lies so far below shaft angle 0
  /// A magnet off its axis adds amplitude × sin(angle + phase), one that is not round amplitude × sin(2 angle + phase).
  /// First amplitude and twice the second must be less than 7900 together, so that the measured angle still only rises.
  struct Harmonic {
    std::int32_t amplitude = 0;
    std::int32_t phase = 0;
  };
  Harmonic first_harmonic{};
  Harmonic second_harmonic{};
};

enum class EncoderChannel : std::uint8_t { a, b, n };

/// Angles are exact: every passage of the null position is seen, also one that goes back at once. Counts and events
/// are a function of the way alone; follow() may leap, as long as the shaft has not turned back in between.
class ShaftEncoder {
 public:
  using Kind = EncoderProperties::Kind;

  /// Of the sensOstep encoder.
  static constexpr std::int64_t absolute_counts_per_turn = 1024;
  /// How far from the null position near_null() holds, in counts of sensOstep: about one full step.
  static constexpr std::int64_t near_counts = 5;

  explicit ShaftEncoder(const EncoderProperties& properties);
  explicit ShaftEncoder(Kind kind) : ShaftEncoder(EncoderProperties{.kind = kind}) {}

  const EncoderProperties& properties() const { return properties_; }
  std::int64_t counts_per_turn() const { return counts_per_turn_; }

  /// The supply comes back: what was counted and noted is lost.
  void power_up();

  /// The shaft, or the load side, has turned. @param angle microsteps
  void follow(std::int64_t angle) {
    if (const std::int64_t place = place_at(angle); place != state_.place) move_to(place);
  }

  /// Counts since power-on. Absolute: its lowest ten bits are the angle.
  std::int64_t count() const { return count_in(state_.place); }
  /// What count() would be at `angle`.
  std::int64_t count_at(std::int64_t angle) const { return count_in(place_at(angle)); }

  /// Within near_counts of the null position, now or at `angle`.
  bool near_null() const { return is_near_null(state_.place); }
  bool near_null_at(std::int64_t angle) const { return is_near_null(place_at(angle)); }

  /// A null event is the arrival at the null position. An incremental encoder's is seen as N at `level` while A and B
  /// are high: with the wrong level that is once in every line but those of the null position.
  /// @return the count at the last such event since the last call
  std::optional<std::int64_t> take_null_event(bool level);

  /// A broken wire leaves the channel high, for its pull-up. Incremental encoders only.
  void break_wire(EncoderChannel channel, bool broken);
  bool wire_broken(EncoderChannel channel) const;

  /// How far from `angle` a null position begins or ends.
  EventDistance null_distance(std::int64_t angle) const;

  /// All that changes, to be saved and restored.
  struct State {
    std::int64_t place = 0;  ///< counts above the place where A and B are first high, over all turns
    std::int64_t zero = 0;   ///< what a decoder has there for count 0
    /// Counts at the last null event that was not taken, for N low and for N high.
    std::array<std::optional<std::int64_t>, 2> events{};
    bool a_broken = false;
    bool b_broken = false;
    bool n_broken = false;

    friend bool operator==(const State&, const State&) = default;
  };
  const State& state() const { return state_; }
  /// @param state of an encoder with the same properties
  void restore(const State& state) { state_ = state; }

 private:
  std::int64_t place_at(std::int64_t angle) const { return place_of(properties_.reversed ? -angle : angle); }
  std::int64_t place_of(std::int64_t turned) const;
  std::int64_t harmonic_error(std::int64_t magnet_angle) const;
  std::int64_t first_turned_at(std::int64_t place) const;
  bool intact() const { return !state_.a_broken && !state_.b_broken && !state_.n_broken; }
  std::int64_t count_in(std::int64_t place) const { return decoded(place) - state_.zero; }
  std::int64_t decoded(std::int64_t place) const;
  std::int64_t seen_quarter(std::int64_t place) const;
  bool is_near_null(std::int64_t place) const;
  bool is_in_null(std::int64_t place) const;
  std::int64_t null_begin_at_or_below(std::int64_t place) const;
  bool shows_event(std::int64_t place, bool level) const;
  std::optional<std::int64_t> last_event(std::int64_t before, std::int64_t after, bool level) const;
  std::optional<std::int64_t> last_event_up(std::int64_t before, std::int64_t after, bool in_null) const;
  std::optional<std::int64_t> last_event_down(std::int64_t before, std::int64_t after, bool in_null) const;
  void move_to(std::int64_t place);

  EncoderProperties properties_;
  std::int64_t counts_per_turn_;
  State state_;
};

}  // namespace opentmcl::twin
