#include "twin/physics/linear_stage.hpp"

#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {

LinearStage::LinearStage(const LinearStageDimensions& dimensions) : dimensions_(dimensions) {
  const std::int32_t end = dimensions.travel / 2;
  const std::int32_t begin_of_switch = end - dimensions.limit_switch_distance;
  const std::int32_t end_of_switch = begin_of_switch + dimensions.limit_switch_width;
  const std::int32_t home = dimensions.home_switch_center;
  const std::int32_t home_half = dimensions.home_switch_width / 2;
  travel_ = angles_between(-end, end);
  left_switch_ = angles_between(-end_of_switch, -begin_of_switch);
  right_switch_ = angles_between(begin_of_switch, end_of_switch);
  home_switch_ = angles_between(home - home_half, home + home_half);
}

LinearStage::AngleRange LinearStage::angles_between(std::int32_t left, std::int32_t right) const {
  // place = start + angle * pitch / microsteps_per_turn, so these angles are the first and the last inside.
  const std::int64_t from = ceiling_quotient((left - dimensions_.start) * microsteps_per_turn, dimensions_.pitch);
  const std::int64_t to = floor_quotient((right - dimensions_.start) * microsteps_per_turn, dimensions_.pitch);
  return dimensions_.mirrored ? AngleRange{-to, -from} : AngleRange{from, to};
}

LinearStage::Contacts LinearStage::contacts_at(std::int64_t angle) const {
  const bool open_when_held = dimensions_.contact == LinearStageDimensions::Contact::normally_closed;
  return {.left = left_switch_.contains(angle) == open_when_held,
          .right = right_switch_.contains(angle) == open_when_held,
          .home = home_switch_.contains(angle) == open_when_held};
}

std::int64_t LinearStage::place_at(std::int64_t angle) const {
  const std::int64_t turned = dimensions_.mirrored ? -angle : angle;
  return dimensions_.start + floor_quotient(turned * dimensions_.pitch, microsteps_per_turn);
}

}  // namespace opentmcl::twin
