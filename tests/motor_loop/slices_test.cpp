// A module with a motor goes the same way however time is cut and whoever looks: the same trace, the same replies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>

#include "tests/motor_loop/motor_bench.hpp"

namespace opentmcl::tests {
namespace {

using testing::HasSubstr;

/// A program that waits, so that the board leaves out turns in which nothing happens, and that meets a limit switch.
constexpr auto back_and_forth = R"(
      SAP 12, 0, 0
      SAP 13, 0, 0
Loop: MVP REL, 0, 20000
      WAIT POS, 0, 50
      MVP REL, 0, -15000
      WAIT POS, 0, 0
      ROR 0, 600
      WAIT TICKS, 0, 7
      MST 0
      JA Loop
)";

constexpr int rounds = 20;
constexpr Microseconds round_length = 123'457;

struct Way {
  Microseconds shortest_slice;
  Microseconds longest_slice;
  bool looks = false;  ///< somebody measures at the bench at the end of each slice
  bool traced = true;  ///< every step is told to an observer
};

struct Outcome {
  std::string trace;
  std::string replies;
  twin::MotorShaft::Memory motor;
};

void look_at_all(const MotorBench& bench) {
  const twin::World& world = bench.world();
  static_cast<void>(world.rotor_angle());
  static_cast<void>(world.encoder_count());
  static_cast<void>(world.place());
  static_cast<void>(world.present_motor()->effort());
  static_cast<void>(world.present_field());
}

/// A slider just before its right limit switch; a load that tears the motor away for a while; a host that asks where
/// it is at times that have nothing to do with the firmware's.
Outcome run(ModuleId module, const Way& way) {
  twin::TraceText trace;
  VirtualModule::Options options;
  std::get<twin::LinearStageDimensions>(options.machine).start = 46'000;
  options.motor = twin::motors().front();
  options.load = 60;
  MotorBench bench(modules[static_cast<std::size_t>(module)], options, way.traced ? &trace : nullptr);
  bench.run_program(back_and_forth);
  bench.port.received.clear();
  std::mt19937 random(1);
  const Microseconds begin = bench.module.now();
  for (int round = 1; round <= rounds; ++round) {
    const Microseconds end = begin + static_cast<Microseconds>(round) * round_length;
    while (bench.module.now() < end) {
      const Microseconds slice = way.shortest_slice + random() % (way.longest_slice - way.shortest_slice + 1);
      bench.module.advance_to(std::min(end, bench.module.now() + slice));
      if (way.looks) look_at_all(bench);
    }
    if (round == 13) bench.set_load_torque(2 * holding_torque());
    if (round == 15) bench.set_load_torque(0);
    const Datagram request = encode(Request{
        1, {static_cast<std::uint8_t>(Opcode::gap), static_cast<std::uint8_t>(AxisParameter::actual_position), 0, 0}});
    bench.port.to_module.insert(bench.port.to_module.end(), request.bytes, request.bytes + datagram_size);
    bench.module.wake();
  }
  return {trace.text(), {bench.port.received.begin(), bench.port.received.end()}, bench.motor().memory()};
}

class Slices : public testing::TestWithParam<ModuleId> {
 protected:
  static constexpr Way whole{round_length, round_length};
};

INSTANTIATE_TEST_SUITE_P(Both, Slices, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161), name_of_module);

TEST_P(Slices, OfTimeChangeNeitherTraceNorReplies) {
  const Outcome expected = run(GetParam(), whole);
  // The last request has not been answered yet.
  EXPECT_EQ(expected.replies.size(), (rounds - 1) * datagram_size);
  EXPECT_THAT(expected.trace, HasSubstr(" right_switch 1\n"));
  // 100 and 1,000 us end just where the firmware takes its turns, the others between them.
  for (const Way& way : {Way{37, 37}, Way{100, 100}, Way{777, 777}, Way{1'000, 1'000}, Way{1, 20'000}}) {
    SCOPED_TRACE(testing::Message() << "slices of " << way.shortest_slice << " to " << way.longest_slice << " us");
    const Outcome outcome = run(GetParam(), way);
    EXPECT_TRUE(outcome.trace == expected.trace);  // too long to be printed
    EXPECT_EQ(outcome.replies, expected.replies);
    EXPECT_EQ(outcome.motor, expected.motor);
  }
}

TEST_P(Slices, MayBeLookedAtAndTracedOrNot) {
  const Outcome expected = run(GetParam(), whole);
  const Outcome looked_at = run(GetParam(), {.shortest_slice = 900, .longest_slice = 1'100, .looks = true});
  EXPECT_TRUE(looked_at.trace == expected.trace);
  EXPECT_EQ(looked_at.motor, expected.motor);
  const Outcome alone =
      run(GetParam(), {.shortest_slice = round_length, .longest_slice = round_length, .traced = false});
  EXPECT_EQ(alone.replies, expected.replies);
  EXPECT_EQ(alone.motor, expected.motor);
}

}  // namespace
}  // namespace opentmcl::tests
