#include "apps/tmcl/motion_state.hpp"

#include <gtest/gtest.h>

namespace opentmcl::app {

TEST(MotionState, ShowsInternalAndPhysicalSpeed) {
  MotionState state;
  state.position = -512000;
  state.velocity = 1000;
  state.microstep_resolution = 8;
  state.pulse_divisor = 3;
  state.program = client::ProgramStatus::State::running;
  EXPECT_EQ("position     -512000  speed  1000 =    35.76 rpm  program running", describe(state));
}

}  // namespace opentmcl::app
