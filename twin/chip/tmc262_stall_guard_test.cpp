// stallGuard2 and coolStep of the TMC262.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "twin/chip/tmc262_test_bench.hpp"

namespace opentmcl::twin {
namespace {

using tmc262::CoolStepControl;
using tmc262::DriverConfiguration;
using tmc262::Reply;
using tmc262::ReplyFormat;
using tmc262::StallGuardAndCurrent;

class Tmc262StallGuardValue : public testing::Test, protected Tmc262Bench {
 protected:
  Tmc262StallGuardValue() { switch_bridges_on(); }
  std::int32_t value() { return Reply::StallGuardValue::in(reply(ReplyFormat::stall_guard)); }
  std::int32_t value_of(std::int32_t measurement) {
    chip.set_load_measurement(measurement);
    take_full_steps(4);
    return value();
  }
};

TEST_F(Tmc262StallGuardValue, IsNoneBeforeTheFirstFullStep) {
  pulse(up, 255);
  EXPECT_EQ(value(), 0);
  EXPECT_FALSE(chip.stall_guard_output());
  pulse(up, 1);
  EXPECT_EQ(value(), 1023);
}

TEST_F(Tmc262StallGuardValue, IsMeasuredAtTheNextFullStep) {
  chip.set_load_measurement(123);
  EXPECT_EQ(value(), 0);
  pulse(up, 256);
  EXPECT_EQ(value(), 123);
  chip.set_load_measurement(0);
  pulse(up, 255);
  EXPECT_FALSE(chip.stall_guard_output()) << "within the full step";
  pulse(up, 1);
  EXPECT_TRUE(chip.stall_guard_output());
  EXPECT_TRUE(Reply::StallGuardReached::is_set(reply()));
}

TEST_F(Tmc262StallGuardValue, IsNotMeasuredWithoutCurrent) {
  chip.set_enable_not(true);
  pulse(up, 2000);
  EXPECT_EQ(value(), 0);
}

TEST_F(Tmc262StallGuardValue, StaysAtStandstill) {
  EXPECT_EQ(value_of(0), 0);
  chip.set_load_measurement(500);
  wait(10'000'000);
  EXPECT_TRUE(chip.stall_guard_output());
}

TEST_F(Tmc262StallGuardValue, NeedsFourFullStepsWithTheFilter) {
  send(StallGuardAndCurrent::Filter::set);
  pulse(up, 1023);
  EXPECT_EQ(value(), 0);
  pulse(up, 1);
  EXPECT_EQ(value(), 1023);
}

TEST_F(Tmc262StallGuardValue, IsTheMeanOfFourFullStepsWithTheFilter) {
  send(StallGuardAndCurrent::Filter::set);
  for (const std::int32_t measurement : {100, 200, -40, 500}) {
    chip.set_load_measurement(measurement);
    take_full_steps(1);
  }
  EXPECT_EQ(value(), (100 + 200 - 40 + 500) / 4);
}

TEST_F(Tmc262StallGuardValue, BeginsANewMeanWhenTheFilterChanges) {
  send(StallGuardAndCurrent::Filter::set);
  take_full_steps(3);
  send(StallGuardAndCurrent::Filter::of(0));
  send(StallGuardAndCurrent::Filter::set);
  take_full_steps(3);
  EXPECT_EQ(value(), 0);
  take_full_steps(1);
  EXPECT_EQ(value(), 1023);
}

TEST_F(Tmc262StallGuardValue, IsMovedByTheThresholdAndLimited) {
  const struct {
    std::int32_t threshold, measurement, value;
  } rows[] = {{0, 500, 500},           {1, 500, 510},    {-1, 500, 490},
              {63, 500, 1023},         {63, 300, 930},   {-64, 500, 0},
              {-64, 1023, 383},        {10, -60, 40},    {0, -60, 0},
              {0, 2000, 1023},         {-64, 1200, 560}, {63, 2'147'483'647, 1023},
              {-64, -2'147'483'647, 0}};
  for (const auto& row : rows) {
    send(StallGuardAndCurrent::Threshold::of(row.threshold));
    EXPECT_EQ(value_of(row.measurement), row.value) << row.threshold << ", " << row.measurement;
    EXPECT_EQ(chip.stall_guard_output(), row.value == 0);
  }
}

TEST_F(Tmc262StallGuardValue, IsMeasuredWithCurrentsByTheBusToo) {
  send(DriverConfiguration::StepDirOff::set | DriverConfiguration::of(ReplyFormat::stall_guard));
  chip.set_load_measurement(77);
  EXPECT_EQ(Reply::StallGuardValue::in(send(tmc262::CoilCurrents::SignA::set)), 0);
  EXPECT_EQ(Reply::StallGuardValue::in(send(tmc262::CoilCurrents::SignA::set)), 77) << "coil A changed its polarity";
}

// ---- coolStep

class Tmc262CoolStepScale : public testing::Test, protected Tmc262Bench {
 protected:
  Tmc262CoolStepScale() {
    switch_bridges_on();
    set_current_scale(highest);
  }
  struct Settings {
    std::int32_t start = 2, width = 2, up = 0, down = 0, minimum = 0;
  };
  void set(const Settings& settings) {
    send(CoolStepControl::HysteresisStart::of(settings.start) | CoolStepControl::HysteresisWidth::of(settings.width) |
         CoolStepControl::CurrentUpStep::of(settings.up) | CoolStepControl::CurrentDownStep::of(settings.down) |
         CoolStepControl::MinimumCurrent::of(settings.minimum));
  }
  /// The scale after so many measurements.
  std::int32_t scale_after(std::uint64_t measurements, std::int32_t value) {
    chip.set_load_measurement(value);
    take_full_steps(measurements);
    EXPECT_EQ(Reply::CurrentScale::in(reply(ReplyFormat::stall_guard_and_current)), chip.current_scale());
    return chip.current_scale();
  }

  static constexpr std::int32_t highest = 20;
  // The thresholds of start and width 2: below 64 more current, at 160 and above less.
  static constexpr std::int32_t much_load = 63;
  static constexpr std::int32_t little_load = 160;
};

TEST_F(Tmc262CoolStepScale, IsTheCurrentScaleWhileCoolStepIsOff) {
  EXPECT_EQ(scale_after(1'000, 1023), highest);
  EXPECT_EQ(scale_after(1'000, 0), highest);
}

TEST_F(Tmc262CoolStepScale, StaysBetweenTheThresholds) {
  set({.down = 3});
  EXPECT_EQ(scale_after(4, little_load), highest - 4);
  EXPECT_EQ(scale_after(1'000, little_load - 1), highest - 4);
  EXPECT_EQ(scale_after(1'000, much_load + 1), highest - 4);
  EXPECT_EQ(scale_after(1, much_load), highest - 3);
  EXPECT_EQ(scale_after(1, little_load), highest - 4);
}

TEST_F(Tmc262CoolStepScale, GoesDownEveryThirtyTwoEightTwoOrOneMeasurements) {
  const std::uint64_t measurements[] = {32, 8, 2, 1};
  for (std::int32_t code = 0; code < 4; ++code) {
    set({.start = 0});
    set({.down = code});
    for (std::int32_t step = 1; step <= 5; ++step) {
      EXPECT_EQ(scale_after(measurements[code] - 1, little_load), highest - step + 1) << code;
      EXPECT_EQ(scale_after(1, little_load), highest - step) << code;
    }
  }
}

TEST_F(Tmc262CoolStepScale, GoesUpByOneTwoFourOrEightWithEachMeasurement) {
  const std::int32_t steps[] = {1, 2, 4, 8};
  for (std::int32_t code = 0; code < 4; ++code) {
    set({.up = code, .down = 3, .minimum = 1});
    EXPECT_EQ(scale_after(100, little_load), highest / 4);
    EXPECT_EQ(scale_after(1, much_load), highest / 4 + steps[code]);
    EXPECT_EQ(scale_after(20, much_load), highest) << "never above CS";
  }
}

TEST_F(Tmc262CoolStepScale, EndsAtAHalfOrAQuarter) {
  for (std::int32_t scale = 0; scale <= tmc262::maximum_current_scale; ++scale) {
    set_current_scale(scale);
    for (std::int32_t minimum = 0; minimum < 2; ++minimum) {
      set({.start = 0});
      set({.down = 3, .minimum = minimum});
      const std::int32_t lowest = scale_after(1'000, little_load);
      const std::int32_t parts = minimum == 0 ? 2 : 4;
      EXPECT_GE(parts * (lowest + 1), scale + 1) << scale;
      EXPECT_LT(parts * lowest, scale + 1) << scale << ": one less would be too little";
    }
  }
}

TEST_F(Tmc262CoolStepScale, CountsOnlyMeasurementsThatFollowEachOther) {
  set({.down = 2});
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(scale_after(1, little_load), highest);
    EXPECT_EQ(scale_after(1, little_load - 1), highest);
  }
}

TEST_F(Tmc262CoolStepScale, StartsAtTheCurrentScaleAndReturnsToItWhenSwitchedOff) {
  set({.down = 3});
  EXPECT_EQ(chip.current_scale(), highest);
  EXPECT_EQ(scale_after(5, little_load), highest - 5);
  set({.start = 0});
  EXPECT_EQ(chip.current_scale(), highest);
}

TEST_F(Tmc262CoolStepScale, MovesWithItsLimitsAtOnce) {
  set({.down = 3});
  set_current_scale(10);
  EXPECT_EQ(chip.current_scale(), 10);
  EXPECT_EQ(scale_after(2, little_load), 8);
  set_current_scale(31);
  EXPECT_EQ(chip.current_scale(), 15);
  set_current_scale(20);
  EXPECT_EQ(chip.current_scale(), 15);
}

TEST_F(Tmc262CoolStepScale, SetsTheCurrent) {
  send(DriverConfiguration::LowSenseVoltage::set);
  const std::int32_t before = chip.current_amplitude();
  set({.down = 3});
  scale_after(100, little_load);
  EXPECT_EQ(chip.current_amplitude(), before * (highest / 2 + 1) / (highest + 1));
}

TEST_F(Tmc262CoolStepScale, FollowsFilteredMeasurementsFourTimesAsSlowly) {
  set({.down = 3});
  send(StallGuardAndCurrent::Filter::set | StallGuardAndCurrent::CurrentScale::of(highest));
  EXPECT_EQ(scale_after(16, little_load), highest - 4);
}

/// Chapter 6, sample by sample.
RC_GTEST_FIXTURE_PROP(Tmc262CoolStepScale, IsWhatTheRulesSayForEveryMeasurement, ()) {
  const Settings settings{.start = *rc::gen::inRange(1, 16),
                          .width = *rc::gen::inRange(0, 16),
                          .up = *rc::gen::inRange(0, 4),
                          .down = *rc::gen::inRange(0, 4),
                          .minimum = *rc::gen::inRange(0, 2)};
  set(settings);
  const int measurements_down[] = {32, 8, 2, 1};
  std::int32_t expected = highest;
  int above = 0;
  for (const auto value : *rc::gen::container<std::vector<std::int32_t>>(rc::gen::inRange(0, 1024))) {
    // Loads stay a while: else one in 32 would never come.
    for (int i = 0; i < 40; ++i) {
      const bool is_above = value >= 32 * (settings.start + settings.width + 1);
      above = is_above ? above + 1 : 0;
      if (value < 32 * settings.start) expected = std::min(expected + (1 << settings.up), highest);
      if (above == measurements_down[settings.down]) {
        above = 0;
        expected = std::max(expected - 1, settings.minimum == 0 ? highest / 2 : highest / 4);
      }
      RC_ASSERT(scale_after(1, value) == expected);
    }
  }
}

}  // namespace
}  // namespace opentmcl::twin
