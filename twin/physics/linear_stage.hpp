// A slider on a screw between two hard ends, with two limit switches and a home switch.
#pragma once

#include <cstdint>

namespace opentmcl::twin {

/// Places are measured from the middle of the travel, to the right; "left" is the side of negative places. The default
/// is the machine of the virtual modules (docs/machine.md).
struct LinearStageDimensions {
  enum class Contact : std::uint8_t {
    normally_closed,  ///< open while the slider holds the switch
    normally_open,    ///< closed while the slider holds the switch
  };

  std::int32_t pitch = 2'000;     ///< µm a turn of the shaft, positive
  std::int32_t travel = 100'000;  ///< µm from one hard end to the other, even
  std::int32_t start = 0;         ///< µm, where the slider stands at shaft angle 0
  bool mirrored = false;          ///< the motor sits at the other end: positive angles move the slider to the left

  std::int32_t limit_switch_distance = 2'000;  ///< µm from a hard end to where the switch closest to it begins
  std::int32_t limit_switch_width = 1'000;     ///< µm for which the slider holds it, towards the end
  std::int32_t home_switch_center = -10'000;   ///< µm
  std::int32_t home_switch_width = 1'000;      ///< µm for which the slider holds it, even
  Contact contact = Contact::normally_closed;
};

/// All of it as functions of the shaft angle in microsteps, exact: no place is rounded.
class LinearStage {
 public:
  explicit LinearStage(const LinearStageDimensions& dimensions);

  /// Angles from `lowest` to `highest`.
  struct AngleRange {
    std::int64_t lowest;
    std::int64_t highest;

    bool contains(std::int64_t angle) const { return lowest <= angle && angle <= highest; }
  };

  /// Between the hard ends.
  const AngleRange& travel() const { return travel_; }

  /// Of the three switches; true is open.
  struct Contacts {
    bool left;
    bool right;
    bool home;

    friend bool operator==(const Contacts&, const Contacts&) = default;
  };
  Contacts contacts_at(std::int64_t angle) const;

  /// Where the slider stands, µm, rounded down.
  std::int64_t place_at(std::int64_t angle) const;

 private:
  AngleRange angles_between(std::int32_t left, std::int32_t right) const;

  LinearStageDimensions dimensions_;
  AngleRange travel_;
  AngleRange left_switch_;
  AngleRange right_switch_;
  AngleRange home_switch_;
};

}  // namespace opentmcl::twin
