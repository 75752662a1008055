// How the boards of the two modules differ between the firmware's pins and the connectors. docs/machine.md lists all
// lines; what TMCL makes of them is firmware/spec/io_ports.hpp.
#pragma once

#include "firmware/spec/modules.hpp"
#include "twin/physics/shaft_encoder.hpp"

namespace opentmcl {

struct ModuleWiring {
  /// sensOstep on the back of the motor, or the ABN input (PD-1161 manual 6.2, TMCM-1110 facts part a.6).
  twin::ShaftEncoder::Kind encoder;
  /// GIO 11,0 reads whether the encoder is near its null position.
  bool shows_encoder_null;
  /// The pull-ups of STOP_L, STOP_R and HOME hang on an output of the processor (SIO 0,0); else they are soldered in.
  bool pull_ups_can_be_switched;
  /// HOME and AIN_0, which is IN0 too, are one line.
  bool home_switch_is_in0;
};

inline constexpr ModuleWiring tmcm1110_wiring{
    .encoder = twin::ShaftEncoder::Kind::incremental,
    .shows_encoder_null = false,
    .pull_ups_can_be_switched = false,
    .home_switch_is_in0 = true,
};

inline constexpr ModuleWiring pd1161_wiring{
    .encoder = twin::ShaftEncoder::Kind::absolute,
    .shows_encoder_null = true,
    .pull_ups_can_be_switched = true,
    .home_switch_is_in0 = false,
};

constexpr const ModuleWiring& wiring_of(ModuleId module) {
  return module == ModuleId::pd1161 ? pd1161_wiring : tmcm1110_wiring;
}

}  // namespace opentmcl
