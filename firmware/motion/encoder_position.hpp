#pragma once

#include <cstdint>

#include "firmware/hal/encoder.hpp"
#include "firmware/motion/axis_settings.hpp"

namespace opentmcl {

/// The encoder's position in microsteps (parameter 209): counts times the prescaler of parameter 210, which is in units
/// of 1/512, plus that parameter's function bits. Nothing is rounded on the way, so nothing drifts however long the
/// motor turns. Sources: PD-1161 manual 6.2; facts about the TMCM-1110 part a.6; docs/decisions/0024-encoder.md.
class EncoderPosition {
 public:
  EncoderPosition(ModuleId module, AxisSettings& settings, hal::Encoder& encoder)
      : module_(module), settings_(settings), encoder_(encoder) {}

  /// Position 0 where the shaft stands.
  void initialise();
  /// Global parameter 90: the encoder counts the other way. The position stays.
  void set_reversed(bool reversed);
  /// Parameter 210 was changed: the position stays, null events of before do not count.
  void apply_prescaler();

  /// @return microsteps, rounded down; wraps at 32 bits
  std::int32_t position();
  void set_position(std::int32_t position);

  /// sensOstep: the angle within a turn, 0…1023, whatever the prescaler (parameter 215).
  std::int32_t absolute_angle();

  /// Takes in what the encoder counted, and a null event that is to clear the position. To be called now and then while
  /// the shaft may turn.
  void follow();

 private:
  bool has_function(std::int32_t bit) const;
  bool take_null_event(std::int32_t& count);
  std::uint64_t scaled(std::int32_t from, std::int32_t to) const;

  ModuleId module_;
  AxisSettings& settings_;
  hal::Encoder& encoder_;
  bool reversed_ = false;
  std::int32_t prescaler_ = 0;  ///< in force, without function bits
  std::int32_t count_ = 0;      ///< of the encoder, as taken in
  std::uint64_t scaled_ =
      0;  ///< position in 1/512 microstep, two's complement; wraps far beyond the position's 32 bits
};

}  // namespace opentmcl
