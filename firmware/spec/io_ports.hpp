// Every port of SIO and GIO of both modules. Sources: PD-1161 manual 3.7.14 and 3.7.15; facts about the TMCM-1110
// part a.5 (docs/decisions/0005-tmcm1110-io.md says which reading of them is used).
#pragma once

#include <cstddef>

#include "firmware/spec/modules.hpp"
#include "firmware/spec/parameter_rows.hpp"

namespace opentmcl {

enum class IoBank : std::uint8_t { digital_inputs = 0, analog_inputs = 1, digital_outputs = 2 };

/// What a port is wired to.
enum class IoLine : std::uint8_t {
  input,                ///< general purpose digital input; `index` is its number
  output,               ///< general purpose digital output; `index` is its number
  all_inputs,           ///< bit vector of the inputs
  all_outputs,          ///< bit vector of the outputs; writing -1 takes the accumulator
  encoder_null,         ///< sensOstep encoder near its absolute zero
  pull_ups,             ///< pull-up resistors of both limit switches and the home switch together
  analog,               ///< general purpose analog input, 12 bit
  supply_voltage,       ///< motor supply
  temperature,          ///< board temperature
  motor_supply_counts,  ///< motor supply, 12-bit converter counts
  logic_supply_counts,  ///< +5 V rail, 12-bit converter counts
};

struct IoPortSpec {
  IoBank bank;
  std::uint8_t port;
  IoLine line;
  std::uint8_t index;
  const char* symbol;
  Access access;  ///< r: GIO, w: SIO
  std::int32_t minimum;
  std::int32_t maximum;
  Unit unit;
  Modules modules;
  const char* description;
};

inline constexpr std::uint8_t all_ports = 255;
/// Highest value of a 12-bit analog-to-digital conversion.
inline constexpr std::int32_t analog_maximum = 4095;
/// In 0.1 V: with less motor supply the firmware stops motor and program. Source: PD-1161 manual, firmware history
/// V1.35; docs/decisions/0026-under-voltage.md.
inline constexpr std::int32_t lowest_supply_voltage = 85;

// clang-format off
inline constexpr IoPortSpec io_ports[] = {
    {IoBank::digital_inputs, 0, IoLine::input, 0, "IN0", Access::r, 0, 1, Unit::none, Modules::tmcm1110,
     "digital input 0"},
    {IoBank::digital_inputs, 0, IoLine::input, 0, "IN0", Access::rw, 0, 1, Unit::none, Modules::pd1161,
     "digital input 0; written: the pull-up resistors of STOP_L, STOP_R and HOME"},
    {IoBank::digital_inputs, 1, IoLine::input, 1, "IN1", Access::r, 0, 1, Unit::none, Modules::both, "digital input 1"},
    {IoBank::digital_inputs, 2, IoLine::input, 2, "IN2", Access::r, 0, 1, Unit::none, Modules::both, "digital input 2"},
    {IoBank::digital_inputs, 3, IoLine::input, 3, "IN3", Access::r, 0, 1, Unit::none, Modules::both, "digital input 3"},
    {IoBank::digital_inputs, 4, IoLine::input, 4, "IN4", Access::r, 0, 1, Unit::none, Modules::tmcm1110,
     "digital input 4"},
    {IoBank::digital_inputs, 5, IoLine::input, 5, "IN5", Access::r, 0, 1, Unit::none, Modules::tmcm1110,
     "digital input 5"},
    {IoBank::digital_inputs, 6, IoLine::input, 6, "IN6", Access::r, 0, 1, Unit::none, Modules::tmcm1110,
     "digital input 6"},
    {IoBank::digital_inputs, 11, IoLine::encoder_null, 0, "ENCODER_NULL", Access::r, 0, 1, Unit::none, Modules::pd1161,
     "1 while the sensOstep encoder is near its absolute zero"},
    {IoBank::digital_inputs, all_ports, IoLine::all_inputs, 0, "IN_ALL", Access::r, 0, 255, Unit::none, Modules::both,
     "all digital inputs as a bit vector"},
    {IoBank::analog_inputs, 0, IoLine::analog, 0, "AIN0", Access::r, 0, analog_maximum, Unit::none, Modules::both,
     "analog input 0"},
    {IoBank::analog_inputs, 1, IoLine::motor_supply_counts, 0, "ADC_SUPPLY", Access::r, 0, analog_maximum, Unit::none,
     Modules::tmcm1110, "motor supply, converter counts"},
    {IoBank::analog_inputs, 2, IoLine::logic_supply_counts, 0, "ADC_5V", Access::r, 0, analog_maximum, Unit::none,
     Modules::tmcm1110, "+5 V rail, converter counts"},
    {IoBank::analog_inputs, 8, IoLine::supply_voltage, 0, "SUPPLY_VOLTAGE", Access::r, 0, 1000, Unit::tenth_volts,
     Modules::both, "supply voltage"},
    {IoBank::analog_inputs, 9, IoLine::temperature, 0, "TEMPERATURE", Access::r, -40, 150, Unit::degrees_celsius,
     Modules::both, "board temperature"},
    {IoBank::digital_outputs, 0, IoLine::output, 0, "OUT0", Access::rw, 0, 1, Unit::none, Modules::both,
     "digital output 0"},
    {IoBank::digital_outputs, 1, IoLine::output, 1, "OUT1", Access::rw, 0, 1, Unit::none, Modules::both,
     "digital output 1"},
    {IoBank::digital_outputs, 2, IoLine::output, 2, "OUT2", Access::rw, 0, 1, Unit::none, Modules::tmcm1110,
     "digital output 2"},
    {IoBank::digital_outputs, 3, IoLine::output, 3, "OUT3", Access::rw, 0, 1, Unit::none, Modules::tmcm1110,
     "digital output 3"},
    {IoBank::digital_outputs, 4, IoLine::output, 4, "OUT4", Access::rw, 0, 1, Unit::none, Modules::tmcm1110,
     "digital output 4"},
    {IoBank::digital_outputs, 5, IoLine::output, 5, "OUT5", Access::rw, 0, 1, Unit::none, Modules::tmcm1110,
     "digital output 5"},
    {IoBank::digital_outputs, 6, IoLine::output, 6, "OUT6", Access::rw, 0, 1, Unit::none, Modules::tmcm1110,
     "digital output 6"},
    {IoBank::digital_outputs, 7, IoLine::output, 7, "OUT7", Access::rw, 0, 1, Unit::none, Modules::tmcm1110,
     "digital output 7"},
    {IoBank::digital_outputs, all_ports, IoLine::all_outputs, 0, "OUT_ALL", Access::rw, -1, 255, Unit::none,
     Modules::both, "all digital outputs as a bit vector; -1 takes the accumulator"},
};
// clang-format on

inline constexpr std::size_t io_port_count = sizeof io_ports / sizeof io_ports[0];

consteval bool io_ports_are_consistent() {
  for (std::size_t module = 0; module < module_count; ++module) {
    int previous = -1;
    for (const IoPortSpec& row : io_ports) {
      if (!contains(row.modules, static_cast<ModuleId>(module))) continue;
      const int key = static_cast<int>(row.bank) * 256 + row.port;
      if (key <= previous) return false;
      previous = key;
    }
  }
  return true;
}
static_assert(io_ports_are_consistent(), "per module: rows sorted and unique");

}  // namespace opentmcl
