#pragma once

#include <cstdint>

namespace opentmcl::hal {

enum class AnalogInput : std::uint8_t {
  ain0,            ///< general purpose analog input, 0…4095
  supply_voltage,  ///< motor supply in 0.1 V; the board does the scaling and tells changes: Module::note_input_change()
  temperature,     ///< board temperature in °C
  supply_counts,   ///< motor supply, 0…4095 converter counts (TMCM-1110)
  logic_supply,    ///< +5 V rail, 0…4095 converter counts (TMCM-1110)
};

/// The analog-to-digital converter of the board.
class Analog {
 public:
  virtual std::int32_t read(AnalogInput input) = 0;

 protected:
  ~Analog() = default;
};

}  // namespace opentmcl::hal
