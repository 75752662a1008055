#include "firmware/motion/encoder_position.hpp"

#include "firmware/motion/wrapping.hpp"

namespace opentmcl {

namespace {

/// Parameter 210 counts the prescaler in 1/512.
constexpr unsigned prescaler_bits = 9;

// Function bits of parameter 210.
constexpr std::int32_t clear_on_null = 4;
constexpr std::int32_t clear_every_time = 8;   // TMCM-1110, together with clear_on_null
constexpr std::int32_t null_high_active = 16;  // TMCM-1110

/// Bits that are not part of the prescaler, by module. The PD-1161 reserves three more, but its own table uses one of
/// them in a prescaler (E-68).
constexpr std::int32_t function_bits[module_count] = {clear_on_null | clear_every_time | null_high_active,
                                                      clear_on_null};

constexpr std::int32_t counts_per_turn = 1024;  // sensOstep

}  // namespace

void EncoderPosition::initialise() {
  apply_prescaler();
  scaled_ = 0;
}

void EncoderPosition::set_reversed(bool reversed) {
  follow();
  reversed_ = reversed;
}

void EncoderPosition::apply_prescaler() {
  std::int32_t old_event = 0;
  take_null_event(old_event);
  // What was counted so far was counted with the prescaler of before.
  const std::int32_t count = encoder_.count();
  scaled_ += scaled(count_, count);
  count_ = count;
  prescaler_ = settings_[AxisParameter::encoder_prescaler] & ~function_bits[static_cast<std::size_t>(module_)];
}

bool EncoderPosition::has_function(std::int32_t bit) const {
  return (settings_[AxisParameter::encoder_prescaler] & function_bits[static_cast<std::size_t>(module_)] & bit) != 0;
}

bool EncoderPosition::take_null_event(std::int32_t& count) {
  return encoder_.take_null_event(has_function(null_high_active), count);
}

/// The way from one count to another in 1/512 microstep.
std::uint64_t EncoderPosition::scaled(std::int32_t from, std::int32_t to) const {
  const auto way = static_cast<std::int64_t>(wrapping_difference(to, from)) * prescaler_;
  return reversed_ ? 0 - static_cast<std::uint64_t>(way) : static_cast<std::uint64_t>(way);
}

void EncoderPosition::follow() {
  std::int32_t null_count = 0;
  // The event first: it lies before the count.
  const bool clears = has_function(clear_on_null) && take_null_event(null_count);
  const std::int32_t count = encoder_.count();
  if (clears) {
    scaled_ = scaled(null_count, count);
    const bool only_once = module_ == ModuleId::tmcm1110 && !has_function(clear_every_time);
    if (only_once) {
      settings_.set(AxisParameter::encoder_prescaler, settings_[AxisParameter::encoder_prescaler] & ~clear_on_null);
    }
  } else {
    scaled_ += scaled(count_, count);
  }
  count_ = count;
}

std::int32_t EncoderPosition::position() {
  follow();
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(scaled_ >> prescaler_bits));
}

void EncoderPosition::set_position(std::int32_t position) {
  follow();
  scaled_ = static_cast<std::uint64_t>(static_cast<std::int64_t>(position)) << prescaler_bits;
}

std::int32_t EncoderPosition::absolute_angle() {
  const std::int32_t count = encoder_.count();
  return (reversed_ ? wrapping_difference(0, count) : count) & (counts_per_turn - 1);
}

}  // namespace opentmcl
