#include "server/simulated_transport.hpp"

#include <gtest/gtest.h>

#include "client/client.hpp"
#include "client/program_transfer.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/open_transport.hpp"

namespace opentmcl::server {
namespace {

using namespace std::chrono_literals;

struct SimulatedTransportTest : testing::Test {
  SimulatedTransport transport{pd1161};
  client::Client client{transport};
};

TEST_F(SimulatedTransportTest, AnswersWithoutLettingTimePass) {
  const client::Duration before = transport.now();
  const auto version = client.firmware_version();
  ASSERT_TRUE(version.ok());
  EXPECT_EQ(&pd1161, version->module());
  EXPECT_LE(transport.now() - before, 1ms);
}

TEST_F(SimulatedTransportTest, MovesTheMotorDuringAPause) {
  ASSERT_TRUE(client.move_to(10000).ok());
  transport.pause(30s);
  EXPECT_EQ(10000, client.axis_parameter(AxisParameter::actual_position).value());
}

TEST_F(SimulatedTransportTest, TakesAProgramAndGivesItBack) {
  const std::vector<Command> program{{static_cast<std::uint8_t>(Opcode::ror), 0, 0, 350},
                                     {static_cast<std::uint8_t>(Opcode::stop), 0, 0, 0}};
  const auto keep_going = [](std::size_t, std::size_t) { return true; };
  const auto loaded = client::download(client, program, 0, keep_going);
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_TRUE(client::verify(client, program, 0, keep_going).ok());
  ASSERT_TRUE(client.start_program().ok());
  transport.pause(100ms);
  EXPECT_EQ(client::ProgramStatus::State::stopped, client.program_status()->state);
  EXPECT_EQ(350, client.axis_parameter(AxisParameter::target_speed).value());
}

TEST_F(SimulatedTransportTest, SpeaksTextInAsciiMode) {
  const auto say = [this](const std::string& text) {
    EXPECT_TRUE(transport.send(std::vector<std::uint8_t>(text.begin(), text.end())).ok());
    std::uint8_t buffer[64];
    return std::string(buffer, buffer + transport.receive(buffer, 100ms).value());
  };
  ASSERT_TRUE(client.execute({static_cast<std::uint8_t>(Opcode::enter_ascii_mode), 0, 0, 0}).ok());
  EXPECT_EQ("A", say("A"));
  EXPECT_EQ("GAP 140, 0\rBA 100 8\r", say("GAP 140, 0\r"));
  EXPECT_EQ("ABIN\rBA 100 0\r", say("ABIN\r"));
  EXPECT_EQ(8, client.axis_parameter(AxisParameter::microstep_resolution).value());
}

TEST_F(SimulatedTransportTest, WaitsInVainForAsLongAsItWasTold) {
  std::uint8_t buffer[9];
  const client::Duration before = transport.now();
  EXPECT_EQ(0u, transport.receive(buffer, 250ms).value());
  EXPECT_EQ(250ms, transport.now() - before);
}

TEST(OpenTransport, KnowsTheVirtualModules) {
  for (const ModuleDescription& module : modules) {
    const auto transport = open_transport(std::string("sim:") + module.argument, 1s);
    ASSERT_TRUE(transport.ok());
    client::Client client(**transport);
    EXPECT_EQ(&module, client.firmware_version()->module());
  }
}

TEST(OpenTransport, NamesTheVirtualModulesThereAre) {
  const auto transport = open_transport("sim:tmcm9999", 1s);
  ASSERT_FALSE(transport.ok());
  EXPECT_EQ(client::ErrorKind::usage, transport.error().kind);
  EXPECT_NE(std::string::npos, transport.error().message.find("sim:pd1161"));
}

}  // namespace
}  // namespace opentmcl::server
