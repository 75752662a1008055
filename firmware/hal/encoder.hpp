#pragma once

#include <cstdint>

namespace opentmcl::hal {

/// The encoder of the motor: sensOstep inside the PD-1161, the ABN input of the TMCM-1110.
class Encoder {
 public:
  /// Counts since power-on; wraps at 32 bits. PD-1161: 1024 counts a turn, the lowest ten bits are the absolute angle.
  /// TMCM-1110: four counts a line of the encoder.
  virtual std::int32_t count() = 0;

  /// Whether the null position was passed since the last call, and the count there, the last one if there were more.
  /// PD-1161: the angle 0. TMCM-1110: an event of the N channel while A and B are active too.
  /// @param high_active level of N that counts, TMCM-1110 only
  virtual bool take_null_event(bool high_active, std::int32_t& count) = 0;

 protected:
  ~Encoder() = default;
};

}  // namespace opentmcl::hal
