#include "twin/physics/place_scale.hpp"

#include <numeric>

namespace opentmcl::twin {

PlaceScale::PlaceScale(std::int64_t numerator, std::int64_t denominator, std::int64_t start)
    : numerator_(numerator), denominator_(denominator * microsteps_per_turn), start_(start) {
  const std::int64_t common = std::gcd(numerator_, denominator_);
  numerator_ /= common;
  denominator_ /= common;
}

}  // namespace opentmcl::twin
