// The rotor of a motor without inertia, friction and load: it stands where the field points.
#pragma once

#include <cstdint>

namespace opentmcl::twin {

class IdealRotor {
 public:
  /// Electrical angles are counted in 1/1024 of a turn of the field, which is four full steps.
  static constexpr std::uint32_t field_turn = 1024;

  /// Turns the shorter way to the nearest place where the rotor stands at `field_angle`, 0…1023; half a turn goes down.
  /// Without current in the coils nobody calls this and the rotor stays where it is.
  void follow(std::uint32_t field_angle) {
    constexpr std::uint32_t half = field_turn / 2;
    const std::uint32_t ahead = (field_angle - static_cast<std::uint32_t>(angle_)) % field_turn;
    angle_ += static_cast<std::int64_t>((ahead + half) % field_turn) - std::int64_t{half};
  }

  /// Shaft angle since power-on, in microsteps of 1/256 full step, positive for rising field angles.
  std::int64_t angle() const { return angle_; }

 private:
  std::int64_t angle_ = 0;
};

}  // namespace opentmcl::twin
