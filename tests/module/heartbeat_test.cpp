// Global parameter 68: without a command for that long the motor is stopped. docs/decisions/0018-heartbeat.md
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr std::int32_t limit = 200;  // ms

Microseconds milliseconds(std::int32_t count) {
  return static_cast<Microseconds>(count) * one_millisecond;
}

/// Whether the rotor stands still for a while. Asks the world, for a command would be a heartbeat.
bool is_at_rest(Bench& bench) {
  const auto before = bench.module.world().rotor_angle();
  bench.wait(milliseconds(50));
  return bench.module.world().rotor_angle() == before;
}

/// As many pieces of raw bytes as last for `duration`, one every 50 ms.
void send_for(Bench& bench, const std::vector<std::uint8_t>& bytes, Microseconds duration) {
  for (Microseconds passed = 0; passed < duration; passed += milliseconds(50)) {
    bench.port.to_module.insert(bench.port.to_module.end(), bytes.begin(), bytes.end());
    bench.module.wake();
    bench.wait(milliseconds(50));
  }
}

std::vector<std::uint8_t> request(std::uint8_t address, Opcode opcode, std::uint8_t type = 0) {
  const Datagram datagram = encode(Request{address, {static_cast<std::uint8_t>(opcode), type, 0, 0}});
  return {datagram.bytes, datagram.bytes + datagram_size};
}

TEST(Heartbeat, StopsTheMotorWhenNoCommandComes) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.command(Opcode::ror, 0, 0, 500);
  bench.wait(milliseconds(limit - 10));
  EXPECT_FALSE(is_at_rest(bench));
  bench.wait(milliseconds(1000));
  EXPECT_TRUE(is_at_rest(bench));
  EXPECT_EQ(bench.get(AxisParameter::target_speed), 0);
}

TEST(Heartbeat, IsOffAtZero) {
  Bench bench(pd1161);
  bench.command(Opcode::ror, 0, 0, 500);
  bench.wait(milliseconds(100'000));
  EXPECT_FALSE(is_at_rest(bench));
}

TEST(Heartbeat, StopsAMoveToAPositionOnItsWay) {
  Bench bench(tmcm1110);
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.command(Opcode::mvp, 0, 0, 10'000'000);
  bench.wait(milliseconds(2000));
  EXPECT_TRUE(is_at_rest(bench));
  EXPECT_LT(bench.get(AxisParameter::actual_position), 10'000'000);
}

TEST(Heartbeat, IsFedByEveryCommandForTheModule) {
  for (const Opcode opcode : {Opcode::gap, Opcode::get_application_status, Opcode::get_information}) {
    Bench bench(pd1161, hal::PortKind::rs485);
    bench.set(GlobalParameter::serial_heartbeat, limit);
    bench.command(Opcode::ror, 0, 0, 500);
    send_for(bench, request(1, opcode), milliseconds(2000));
    EXPECT_FALSE(is_at_rest(bench));
  }
}

TEST(Heartbeat, IsFedOverTheSecondaryAddress) {
  Bench bench(pd1161, hal::PortKind::rs485);
  bench.set(GlobalParameter::serial_secondary_address, 9);
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.command(Opcode::ror, 0, 0, 500);
  send_for(bench, request(9, Opcode::gap), milliseconds(2000));
  EXPECT_FALSE(is_at_rest(bench));
}

TEST(Heartbeat, IsNotFedByDatagramsToOthersOrWithAWrongChecksum) {
  std::vector<std::uint8_t> broken = request(1, Opcode::gap);
  broken.back() ^= 1;
  for (const std::vector<std::uint8_t>& bytes : {request(3, Opcode::gap), broken}) {
    Bench bench(pd1161, hal::PortKind::rs485);
    bench.set(GlobalParameter::serial_heartbeat, limit);
    bench.command(Opcode::ror, 0, 0, 500);
    send_for(bench, bytes, milliseconds(2000));
    EXPECT_TRUE(is_at_rest(bench));
  }
}

TEST(Heartbeat, IsFedByCommandsInAsciiMode) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.command(Opcode::ror, 0, 0, 500);
  bench.command(Opcode::enter_ascii_mode);
  const std::string nonsense = "A?\r";
  const std::string command = "AGAP 1, 0\r";
  send_for(bench, {command.begin(), command.end()}, milliseconds(2000));
  EXPECT_FALSE(is_at_rest(bench));
  send_for(bench, {nonsense.begin(), nonsense.end()}, milliseconds(2000));
  EXPECT_TRUE(is_at_rest(bench));
}

TEST(Heartbeat, LetsTheMotorMoveAgainWhenCommandsCome) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::serial_heartbeat, limit);
  for (int round = 0; round < 3; ++round) {
    bench.command(Opcode::ror, 0, 0, 500);
    bench.wait(milliseconds(100));
    EXPECT_FALSE(is_at_rest(bench));
    bench.wait(milliseconds(2000));
    EXPECT_TRUE(is_at_rest(bench));
  }
}

TEST(Heartbeat, HoldsTheMotorAgainstAProgramThatGoesOn) {
  Bench bench(pd1161);
  bench.run_program("Loop: ROR 0, 500\nCALC ADD, 1\nAGP 1, 2\nWAIT TICKS, 0, 1\nJA Loop\n");
  bench.wait(milliseconds(500));
  EXPECT_FALSE(is_at_rest(bench));
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.wait(milliseconds(2000));
  EXPECT_TRUE(is_at_rest(bench));
  const std::int32_t count = bench.command(Opcode::ggp, 1, 2).value;
  bench.wait(milliseconds(100));
  EXPECT_FALSE(is_at_rest(bench)) << "the question was a heartbeat";
  EXPECT_GT(bench.command(Opcode::ggp, 1, 2).value, count) << "the program has not been stopped";
}

TEST(Heartbeat, EndsAReferenceSearch) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.command(Opcode::rfs);
  bench.wait(milliseconds(100));
  EXPECT_FALSE(is_at_rest(bench));
  bench.wait(milliseconds(2000));
  EXPECT_TRUE(is_at_rest(bench));
  EXPECT_EQ(bench.command(Opcode::rfs, 2).value, 15) << "aborted";
}

TEST(Heartbeat, LeavesAMotorAloneThatStandsAnyway) {
  Bench bench(pd1161);
  bench.command(Opcode::mvp, 0, 0, 1000);
  bench.wait(milliseconds(10'000));
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.wait(milliseconds(1000));
  EXPECT_EQ(bench.get(AxisParameter::ramp_mode), 0) << "still positioning";
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 1000);
}

TEST(Heartbeat, IsWatchedFromTheStart) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::auto_start, 1);
  bench.download("ROR 0, 500\nLoop: JA Loop\n");
  bench.set(GlobalParameter::serial_heartbeat, limit);
  bench.wait(milliseconds(1000));
  bench.module.power_cycle();
  bench.wait(milliseconds(150));
  EXPECT_FALSE(is_at_rest(bench));
  bench.wait(milliseconds(1500));
  EXPECT_TRUE(is_at_rest(bench));
}

}  // namespace
}  // namespace opentmcl::tests
