#pragma once

#include <cstdint>

namespace opentmcl::hal {

/// Digital lines into the microcontroller, as bit numbers of Pins::inputs(). Limit switches are not here: they are
/// wired to the TMC429.
enum class InputPin : std::uint8_t {
  in0 = 0,  ///< general purpose input IN0; IN1 to IN7 follow
  home_switch = 8,
  stall_guard = 9,       ///< SG_TST of the TMC262: high while the stallGuard2 threshold is reached
  encoder_null = 10,     ///< sensOstep encoder near its absolute zero (PD-1161, GIO 11,0)
  step_dir_enable = 11,  ///< ENABLE of the step/direction connector
};

/// Digital lines out of the microcontroller, as bit numbers of Pins::set_outputs().
enum class OutputPin : std::uint8_t {
  out0 = 0,            ///< general purpose output OUT0; OUT1 to OUT7 follow
  pull_ups = 8,        ///< of the inputs of both limit switches and the home switch (PD-1161)
  driver_disable = 9,  ///< ENN of the TMC262
};

/// The bit of a line in Pins::inputs().
constexpr std::uint32_t bit(InputPin pin) {
  return 1U << static_cast<unsigned>(pin);
}
/// The bit of a line in Pins::set_outputs().
constexpr std::uint32_t bit(OutputPin pin) {
  return 1U << static_cast<unsigned>(pin);
}

/// @param levels of Pins::inputs()
constexpr bool is_high(std::uint32_t levels, InputPin pin) {
  return (levels & bit(pin)) != 0;
}

/// All digital lines of the board at once, one bit each.
class Pins {
 public:
  virtual std::uint32_t inputs() = 0;
  virtual void set_outputs(std::uint32_t levels) = 0;

 protected:
  ~Pins() = default;
};

}  // namespace opentmcl::hal
