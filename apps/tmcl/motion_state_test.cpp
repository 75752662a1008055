#include "apps/tmcl/motion_state.hpp"

#include <gtest/gtest.h>

#include "server/simulated_transport.hpp"

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

TEST(MotionState, IsThatOfTheModule) {
  server::MemoryLine line;
  VirtualModule module(pd1161, {{&line.port(), hal::PortKind::usb}});
  server::SimulatedTransport transport(module, line, "test");
  client::Client client(transport);
  ASSERT_TRUE(client.move_to(-5000).ok());
  transport.pause(std::chrono::seconds(30));
  EXPECT_EQ(-5000, motion_state_of(module).position);
  EXPECT_EQ(0, motion_state_of(module).velocity);
  ASSERT_TRUE(client.rotate(77).ok());
  transport.pause(std::chrono::seconds(1));
  const MotionState state = motion_state_of(module);
  EXPECT_GT(state.position, -5000);
  EXPECT_EQ(77, state.velocity);
  EXPECT_EQ(8, state.microstep_resolution);
  EXPECT_EQ(3, state.pulse_divisor);
  EXPECT_EQ(client::ProgramStatus::State::stopped, state.program);
}

TEST(MotionState, IsSeenWithoutACommand) {
  server::MemoryLine line;
  VirtualModule module(pd1161, {{&line.port(), hal::PortKind::usb}});
  server::SimulatedTransport transport(module, line, "test");
  client::Client client(transport);
  constexpr std::int32_t heartbeat = 200;  // ms
  ASSERT_TRUE(client
                  .set_global_parameter(static_cast<std::uint8_t>(GlobalParameter::serial_heartbeat),
                                        Bank::module_settings, heartbeat)
                  .ok());
  ASSERT_TRUE(client.rotate(500).ok());
  for (int looks = 0; looks < 20; ++looks) {
    transport.pause(std::chrono::milliseconds(100));
    motion_state_of(module);
  }
  EXPECT_EQ(0, motion_state_of(module).velocity) << "looking was no heartbeat";
}

}  // namespace opentmcl::app
