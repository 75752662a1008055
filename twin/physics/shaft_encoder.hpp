// An encoder on the motor's shaft: 1024 counts a turn and one null position.
#pragma once

#include <cstdint>
#include <optional>

namespace opentmcl::twin {

/// Angles are exact: every passage of the null position is seen, also one that goes back at once. The null position is
/// where the shaft stood in the beginning; it moves with the shaft and survives a loss of power.
class ShaftEncoder {
 public:
  enum class Kind : std::uint8_t {
    absolute,     ///< sensOstep in the PD-1161: 1024 angles a turn; knows its angle at power-on, but not the turns
    incremental,  ///< three channels A, B and N with 256 lines a turn; counts from 0 at power-on
  };
  static constexpr std::int64_t counts_per_turn = 1024;

  /// How far from the null position near_null() holds, in counts: about one full step.
  static constexpr std::int64_t near_counts = 5;

  /// @param null_level level of N at the null position; elsewhere it has the other one. Incremental encoders only.
  explicit ShaftEncoder(Kind kind, bool null_level = false) : kind_(kind), null_level_(null_level) {}

  Kind kind() const { return kind_; }

  /// The supply comes back: what was counted and noted is lost.
  void power_up();

  /// The shaft has turned. @param angle microsteps
  void follow(std::int64_t angle) {
    if (angle < count_begins_ || angle >= count_ends_) move_to(angle);
  }

  /// Counts since power-on. Absolute: its lowest ten bits are the angle.
  std::int64_t count() const { return place_ - zero_; }

  bool near_null() const;

  /// A null event is the arrival at the null position. An incremental encoder's is seen as N at `level` while A and B
  /// are high: with the wrong level that is once in every line but the one of the null position.
  /// @return the count at the last such event since the last call
  std::optional<std::int64_t> take_null_event(bool level);

 private:
  void move_to(std::int64_t angle);
  void note_null_events(std::int64_t before);

  Kind kind_;
  bool null_level_;
  std::int64_t place_ = 0;  ///< counts from the null position, over all turns
  std::int64_t zero_ = 0;   ///< place of count 0
  std::int64_t count_begins_ = 0;
  std::int64_t count_ends_ = 0;  ///< angles in between have the same count
  std::optional<std::int64_t> null_passed_;
  std::optional<std::int64_t> other_line_passed_;
};

}  // namespace opentmcl::twin
