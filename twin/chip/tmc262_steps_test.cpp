// The sequencer of the TMC262: resolutions, edges, microPlyer, and runs of steps taken at once.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <vector>

#include "twin/chip/tmc262_test_bench.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::ChopperConfiguration;
using tmc262::CoolStepControl;
using tmc262::DriverControl;
using tmc262::StallGuardAndCurrent;
using tmc262::Word;

class Tmc262Resolution : public testing::TestWithParam<int>, protected Tmc262Bench {};

TEST_P(Tmc262Resolution, MovesTheSequencerByTwoToItsPower) {
  send(DriverControl::Resolution::of(GetParam()));
  pulse(up, 1);
  EXPECT_EQ(chip.microstep_position(), 1u << GetParam());
  pulse(down, 2);
  EXPECT_EQ(chip.microstep_position(), 1024u - (1u << GetParam()));
  pulse(up, 1 + (1024u >> GetParam()));
  EXPECT_EQ(chip.microstep_position(), 0u);
  EXPECT_EQ(chip.microsteps_per_pulse(), 1 << GetParam());
}

INSTANTIATE_TEST_SUITE_P(AllResolutions, Tmc262Resolution, testing::Range(0, 9));

class Tmc262Steps : public testing::Test, protected Tmc262Bench {
 protected:
  std::int64_t edges(std::uint64_t count, StepSignal first) { return chip.steps(count, first, up, 0, 0); }
};

TEST_F(Tmc262Steps, CountOnRisingEdgesUnlessBothAreEnabled) {
  EXPECT_EQ(edges(1, StepSignal::falling), 0);
  EXPECT_EQ(edges(1, StepSignal::rising), 1);
  EXPECT_EQ(edges(5, StepSignal::rising), 3);
  EXPECT_EQ(edges(5, StepSignal::falling), 2);
  EXPECT_EQ(edges(5, StepSignal::pulse), 5);
  EXPECT_EQ(chip.microstep_position(), 11u);
  send(DriverControl::StepOnBothEdges::set);
  EXPECT_EQ(edges(5, StepSignal::rising), 5);
  EXPECT_EQ(edges(5, StepSignal::falling), 5);
  EXPECT_EQ(edges(5, StepSignal::pulse), 10);
  EXPECT_EQ(chip.microstep_position(), 31u);
  EXPECT_EQ(chip.microsteps_per_pulse(), 2);
}

TEST_F(Tmc262Steps, ReturnTheWayWithoutTheWrapOfTheSequencer) {
  EXPECT_EQ(chip.steps(1'000'000, StepSignal::pulse, down, 0, 50'000'000), -1'000'000);
  EXPECT_EQ(chip.microstep_position(), 1024u - 1'000'000u % 1024);
  EXPECT_EQ(chip.clock(), 50'000'000u);
}

// ---- microPlyer

class Tmc262MicroPlyer : public testing::Test, protected Tmc262Bench {
 protected:
  Tmc262MicroPlyer() { send(sixteenth | DriverControl::Interpolation::set); }
  /// MSTEP some clocks after the latest step.
  std::uint32_t position_after(std::uint64_t clocks) { return chip.microstep_position(chip.clock() + clocks); }

  static constexpr Word<DriverControl> sixteenth = DriverControl::Resolution::of(4);
};

TEST_F(Tmc262MicroPlyer, SpreadsSixteenMicrostepsOverThePeriodOfTheStepBefore) {
  EXPECT_TRUE(chip.interpolates());
  pulse_every(1600, up, 2);
  EXPECT_EQ(chip.microstep_position(), 32u);
  for (std::uint64_t clocks = 0; clocks < 2000; ++clocks) {
    ASSERT_EQ(position_after(clocks), std::min<std::uint64_t>(16 + 1 + clocks / 100, 32)) << clocks;
  }
}

TEST_F(Tmc262MicroPlyer, PlaysDownwardsAndThroughTheEndOfTheTable) {
  pulse_every(1600, down, 1);
  pulse_every(1600, down, 1);
  for (std::uint64_t clocks = 0; clocks < 2000; ++clocks) {
    ASSERT_EQ(position_after(clocks), std::max<std::uint64_t>(1024 - 17 - clocks / 100, 1024 - 32)) << clocks;
  }
}

TEST_F(Tmc262MicroPlyer, JumpsWhatIsMissingWhenTheNextStepComesEarly) {
  pulse_every(1600, up, 2);
  pulse_every(400, up, 1);
  EXPECT_EQ(position_after(0), 33u) << "after 5 of the 16 microsteps";
  EXPECT_EQ(position_after(25), 34u) << "the period is now a shorter one";
}

TEST_F(Tmc262MicroPlyer, GivesASteadyOutputForASteadyInput) {
  pulse_every(1600, up, 10);
  std::uint32_t expected = chip.microstep_position(chip.clock());
  for (int microstep = 0; microstep < 100; ++microstep) {
    EXPECT_EQ(chip.microstep_position(chip.clock()), expected);
    wait(100);
    ++expected;
    if (microstep % 16 == 15) pulse(up, 1);
  }
}

TEST_F(Tmc262MicroPlyer, PlaysTheFirstStepAfterAStandstillInTheLongestPeriod) {
  wait(100'000'000);
  pulse(up, 1);
  EXPECT_EQ(position_after((1 << 16) - 1), 1u);
  EXPECT_EQ(position_after(1 << 16), 2u);
  EXPECT_EQ(position_after(15 << 16), 16u);
  EXPECT_EQ(position_after(16 << 16), 16u);
}

TEST_F(Tmc262MicroPlyer, ShowsItsPositionInRepliesAndCurrents) {
  switch_bridges_on();
  pulse_every(1600, up, 2);
  wait(700);
  EXPECT_EQ(tmc262::Reply::MicrostepPosition::in(reply()), 24);
  const Tmc262::CoilPair currents = chip.coil_currents();
  chip.steps(1, StepSignal::pulse, up, chip.clock(), chip.clock());
  EXPECT_NE(chip.coil_currents(), currents);
}

TEST_F(Tmc262MicroPlyer, GivesOutTheRestWhenItIsSwitchedOff) {
  pulse_every(1600, up, 2);
  send(sixteenth);
  EXPECT_EQ(position_after(0), 32u);
  send(sixteenth | DriverControl::Interpolation::set);
  EXPECT_EQ(position_after(0), 32u);
}

TEST_F(Tmc262MicroPlyer, ActsWithSixteenMicrostepsOnly) {
  for (const int resolution : {0, 1, 2, 3, 5, 6, 7, 8}) {
    send(DriverControl::Resolution::of(resolution) | DriverControl::Interpolation::set);
    EXPECT_FALSE(chip.interpolates());
    pulse_every(1600, up, 3);
    EXPECT_EQ(position_after(0), chip.microstep_position()) << resolution;
  }
}

// ---- A run is its steps one by one.

/// A chip in any state, with everything on that steps can act upon.
void prepare(Tmc262Bench& bench) {
  const auto bit = [] { return *rc::gen::inRange(0, 2); };
  const auto field = [](std::int32_t end) { return *rc::gen::inRange(0, end); };
  bench.send(DriverControl::Resolution::of(field(9)) | DriverControl::StepOnBothEdges::of(bit()) |
             DriverControl::Interpolation::of(bit()));
  bench.send(ChopperConfiguration::OffTime::of(field(16)));
  bench.send(CoolStepControl::HysteresisStart::of(field(4)) | CoolStepControl::HysteresisWidth::of(field(3)) |
             CoolStepControl::CurrentDownStep::of(field(4)) | CoolStepControl::CurrentUpStep::of(field(4)) |
             CoolStepControl::MinimumCurrent::of(bit()));
  bench.send(StallGuardAndCurrent::CurrentScale::of(field(32)) |
             StallGuardAndCurrent::Threshold::of(*rc::gen::inRange(-3, 4)) | StallGuardAndCurrent::Filter::of(bit()));
  // Some steps with other loads before: filters and counters are somewhere in between.
  for (const auto measurement : *rc::gen::container<std::vector<std::int32_t>>(3, rc::gen::inRange(-50, 300))) {
    bench.chip.set_load_measurement(measurement);
    bench.pulse_every(*rc::gen::inRange(1u, 5'000u), bit() != 0, *rc::gen::inRange(1u, 3'000u));
  }
  for (const auto coil : {Tmc262::Coil::a, Tmc262::Coil::b}) {
    if (*rc::gen::inRange(0, 4) == 0) bench.chip.set_coil_connected(coil, false);
    if (*rc::gen::inRange(0, 4) == 0) {
      bench.chip.set_short_to_ground(coil, true);
      bench.wait(*rc::gen::inRange(0u, 1'500u));
      if (bit() != 0) bench.chip.set_short_to_ground(coil, false);
    }
  }
}

StepSignal opposite(StepSignal signal) {
  if (signal == StepSignal::pulse) return signal;
  return signal == StepSignal::rising ? StepSignal::falling : StepSignal::rising;
}

RC_GTEST_PROP(Tmc262Run, LeavesTheSameChipAsItsStepsOneByOneAndAsAnyCutOfIt, ()) {
  Tmc262Bench bench;
  prepare(bench);
  const auto count = *rc::gen::inRange<std::uint64_t>(1, 2'000);
  const auto interval = *rc::gen::inRange<std::uint64_t>(0, 3'000);
  const auto first = *rc::gen::element(StepSignal::pulse, StepSignal::rising, StepSignal::falling);
  const bool direction = *rc::gen::arbitrary<bool>();
  const std::uint64_t begin = bench.chip.clock() + *rc::gen::inRange<std::uint64_t>(0, 3'000);

  Tmc262 whole = bench.chip;
  const std::int64_t way = whole.steps(count, first, direction, begin, begin + interval * (count - 1));

  Tmc262 single = bench.chip;
  std::int64_t single_way = 0;
  StepSignal signal = first;
  for (std::uint64_t i = 0; i < count; ++i) {
    single_way += single.steps(1, signal, direction, begin + interval * i, begin + interval * i);
    signal = opposite(signal);
  }
  RC_ASSERT(single == whole);
  RC_ASSERT(single_way == way);

  Tmc262 cut = bench.chip;
  signal = first;
  for (std::uint64_t done = 0; done < count;) {
    const auto part = *rc::gen::inRange<std::uint64_t>(1, count - done + 1);
    cut.steps(part, signal, direction, begin + interval * done, begin + interval * (done + part - 1));
    cut.advance(begin + interval * (done + part - 1) + interval / 2);
    done += part;
    if (part % 2 == 1) signal = opposite(signal);
  }
  whole.advance(cut.clock());
  RC_ASSERT(cut == whole);
}

}  // namespace
}  // namespace opentmcl::twin
