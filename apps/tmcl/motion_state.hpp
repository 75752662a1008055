// What the live lines of `sim` and `run` show.
#pragma once

#include <cstdint>
#include <string>

#include "boards/twin/virtual_module.hpp"
#include "client/client.hpp"

namespace opentmcl::app {

struct MotionState {
  std::int32_t position = 0;              ///< microsteps
  std::int32_t velocity = 0;              ///< internal units
  std::int32_t microstep_resolution = 0;  ///< axis parameter 140
  std::int32_t pulse_divisor = 0;         ///< axis parameter 154
  client::ProgramStatus::State program = client::ProgramStatus::State::stopped;
};

/// What a virtual module is doing, seen from outside: it does not notice.
MotionState motion_state_of(VirtualModule& module);

/// "position -1234567  speed 1000 = 35.76 rpm  program running"
std::string describe(const MotionState& state);

}  // namespace opentmcl::app
