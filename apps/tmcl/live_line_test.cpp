#include "apps/tmcl/live_line.hpp"

#include <gtest/gtest.h>

#include "boards/twin/virtual_module.hpp"
#include "client/client.hpp"
#include "server/simulated_transport.hpp"

namespace opentmcl::app {
namespace {

struct LiveLineTest : testing::Test {
  server::MemoryLine line;
  server::MemoryLine other_line;
  VirtualModule module{pd1161, {{&line.port(), hal::PortKind::usb}, {&other_line.port(), hal::PortKind::usb}}};
  LiveLine live{line};
};

TEST_F(LiveLineTest, ShowsWhatTheModuleAnswers) {
  server::SimulatedTransport transport(module, other_line, "test");
  client::Client client(transport);
  ASSERT_TRUE(client.move_to(-5000).ok());
  transport.pause(std::chrono::seconds(30));
  ASSERT_TRUE(client.rotate(77).ok());
  transport.pause(std::chrono::seconds(1));
  live.ask();
  transport.pause(std::chrono::milliseconds(10));
  while (line.port().size() > 0) {
    module.wake();
    module.advance_to(module.now());
  }
  const std::optional<MotionState> state = live.take_answers();
  ASSERT_TRUE(state.has_value());
  EXPECT_GT(state->position, -5000);
  EXPECT_EQ(77, state->velocity);
  EXPECT_EQ(8, state->microstep_resolution);
  EXPECT_EQ(3, state->pulse_divisor);
  EXPECT_EQ(client::ProgramStatus::State::stopped, state->program);
}

TEST_F(LiveLineTest, HasNothingToShowBeforeAllAnswersAreThere) {
  EXPECT_FALSE(live.take_answers().has_value());
  live.ask();
  EXPECT_FALSE(live.take_answers().has_value());
}

TEST_F(LiveLineTest, AsksAgainOnlyWhenItWasAnswered) {
  live.ask();
  const std::size_t asked = line.port().size();
  live.ask();
  EXPECT_EQ(asked, line.port().size());
}

}  // namespace
}  // namespace opentmcl::app
