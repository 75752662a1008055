// The rotor of a motor without inertia, friction and load: it stands where the field points, or at a hard end.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace opentmcl::twin {

class IdealRotor {
 public:
  /// Electrical angles are counted in 1/1024 of a turn of the field, which is four full steps.
  static constexpr std::uint32_t field_turn = 1024;

  /// A rotor that turns freely.
  IdealRotor() = default;
  /// A rotor that cannot leave the angles `lowest` to `highest`, with 0 between them.
  IdealRotor(std::int64_t lowest, std::int64_t highest) : lowest_(lowest), highest_(highest) {}

  /// Turns the shorter way to the nearest place where the rotor stands at `field_angle`, 0…1023; half a turn goes down.
  /// A hard end stops it on the way. A field that runs on turns ahead of it until, half a turn further, the shorter way
  /// leads back: the rotor has lost four full steps.
  /// Without current in the coils nobody calls this and the rotor stays where it is.
  void follow(std::uint32_t field_angle) {
    constexpr std::uint32_t half = field_turn / 2;
    const std::uint32_t ahead = (field_angle - static_cast<std::uint32_t>(angle_)) % field_turn;
    const std::int64_t way = static_cast<std::int64_t>((ahead + half) % field_turn) - std::int64_t{half};
    angle_ = std::clamp(angle_ + way, lowest_, highest_);
  }

  /// How far it may turn either way before it comes to an end, in microsteps.
  std::int64_t distance_to_end() const {
    constexpr std::int64_t limit = std::numeric_limits<std::int64_t>::max();
    const std::int64_t down = lowest_ == std::numeric_limits<std::int64_t>::min() ? limit : angle_ - lowest_;
    return std::min(down, highest_ == limit ? limit : highest_ - angle_);
  }

  /// Turns with a field that it follows, less far than to an end. @param microsteps positive for rising field angles
  void turn(std::int64_t microsteps) { angle_ += microsteps; }

  /// Shaft angle since power-on, in microsteps of 1/256 full step, positive for rising field angles.
  std::int64_t angle() const { return angle_; }

 private:
  std::int64_t angle_ = 0;
  std::int64_t lowest_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t highest_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace opentmcl::twin
