// Leaps of the ramp generator against its laws iterated tick by tick.
#include "twin/chip/tmc429_ramp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

#include "twin/chip/dice.hpp"
#include "twin/chip/tmc429_choices.hpp"
#include "twin/chip/tmc429_ramp_reference.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::RampMode;

/// What somebody may do to the axis between two leaps, out of all that its registers can hold; often a sensible motion.
class Mischief {
 public:
  explicit Mischief(std::uint64_t seed) : dice_(seed) {}

  Dice& dice() { return dice_; }

  Tmc429RampState anything() {
    Tmc429RampState state;
    state.now = dice_.below(1 << 24);
    state.accumulator = static_cast<std::uint32_t>(dice_.below(Tmc429PulseTrain::step));
    state.settings.mode = any_mode();
    choose_dividers(state.settings);
    choose_acceleration(state.settings);
    choose_velocities(state.settings);
    state.settings.target_velocity = dice_.between(-2048, 2047);
    state.settings.target_position = any_position();
    return state;
  }

  /// One to three registers written.
  void write(Tmc429Ramp& ramp) {
    Tmc429RampSettings settings = ramp.settings();
    switch (dice_.below(12)) {
      case 0:
        choose_dividers(settings);
        choose_acceleration(settings);
        settings.mode = any_mode();
        break;
      case 1:
        settings.mode = any_mode();
        break;
      case 2:
        choose_acceleration(settings);
        break;
      case 3:
        choose_velocities(settings);
        break;
      case 4:
      case 5:
      case 6:
        settings.target_velocity = dice_.between(-2048, 2047);
        settings.target_position = target_near(dice_.once_in(2) ? ramp.position() : 0);
        break;
      case 7:
        ramp.set_velocity(dice_.between(-2047, 2047));
        break;
      case 8:
        if (dice_.once_in(4)) {
          ramp.set_position(dice_.once_in(2) ? settings.target_position : any_position());
        }
        break;
      case 9:
        ramp.block({dice_.once_in(2), dice_.once_in(2), dice_.once_in(2)});
        break;
      case 10:
        ramp.block({});
        break;
      default:
        break;
    }
    ramp.configure(settings);
  }

 private:
  std::int32_t any_position() { return tmc429_choices::distance(0, dice_.signed_of_any_length(24)); }

  std::int32_t target_near(std::int32_t position) {
    if (dice_.once_in(20)) {
      constexpr std::int32_t farthest = 1 << (tmc429::position_bits - 1);
      return tmc429_choices::distance(0, position + farthest + dice_.signed_of_any_length(10));
    }
    return tmc429_choices::distance(0, position + dice_.signed_of_any_length(23));
  }

  RampMode any_mode() {
    if (dice_.once_in(2)) {
      return RampMode::ramp;
    }
    return static_cast<RampMode>(dice_.below(4));
  }

  void choose_dividers(Tmc429RampSettings& settings) {
    settings.pulse_divider = static_cast<unsigned>(dice_.below(14));
    // Those of a sensible motion are close to each other.
    settings.ramp_divider =
        dice_.once_in(3)
            ? static_cast<unsigned>(dice_.below(14))
            : static_cast<unsigned>(std::clamp(static_cast<int>(settings.pulse_divider) + dice_.between(-2, 4), 0, 13));
  }

  void choose_acceleration(Tmc429RampSettings& settings) {
    settings.maximum_acceleration = dice_.between(0, dice_.once_in(2) ? 2047 : 60);
    if (dice_.once_in(8)) {
      settings.multiplier = static_cast<std::uint32_t>(dice_.between(128, 255));
      settings.divisor = static_cast<std::uint32_t>(dice_.below(16));
      return;
    }
    // p = A_MAX / (128 2^(RAMP_DIV - PULSE_DIV)) (page 29) brakes just in time; now and then it is too large.
    const double exact = std::ldexp(settings.maximum_acceleration / 128.0,
                                    static_cast<int>(settings.pulse_divider) - static_cast<int>(settings.ramp_divider));
    const double p = exact * (0.95 + 0.01 * static_cast<double>(dice_.below(8)));
    settings.divisor = 0;
    while (settings.divisor < 13 && std::ldexp(p, 3 + static_cast<int>(settings.divisor)) < 128) {
      ++settings.divisor;
    }
    const double multiplier = std::ldexp(p, 3 + static_cast<int>(settings.divisor));
    settings.multiplier = static_cast<std::uint32_t>(std::clamp(multiplier, 128.0, 255.0));
  }

  void choose_velocities(Tmc429RampSettings& settings) {
    settings.maximum_velocity = dice_.between(0, dice_.once_in(5) ? 50 : 2047);
    settings.minimum_velocity = dice_.once_in(3) ? dice_.between(0, 60) : 1;
    if (dice_.once_in(30)) {
      settings.minimum_velocity = dice_.between(0, 2047);
    }
  }

  Dice dice_;
};

/// A leaping ramp and the reference side by side.
class SideBySide {
 public:
  explicit SideBySide(std::uint64_t seed) : mischief_(seed) {}

  /// Starts anew, or writes registers of what is running; then lets up to so many ticks pass.
  void one_case(std::uint64_t ticks) {
    Dice& dice = mischief_.dice();
    if (cases_++ % 16 == 0) {
      ramp_ = Tmc429Ramp(mischief_.anything());
    }
    mischief_.write(ramp_);
    const std::uint64_t end = ramp_.now() + ticks;
    Tmc429Reach reach;
    if (dice.once_in(4)) {
      reach = {1 + dice.of_any_length(16), 1 + dice.of_any_length(16)};
    }
    const auto until = dice.once_in(8) ? Tmc429Ramp::Until::velocity_changes : Tmc429Ramp::Until::end;
    const bool listed = dice.once_in(8) || list_always_;
    for (int leaps = 0; ramp_.now() < end && leaps < 20; ++leaps) {
      leap(end, reach, until, listed);
    }
  }

  void leap(std::uint64_t end, const Tmc429Reach& reach, Tmc429Ramp::Until until, bool listed) {
    const Tmc429RampState before = ramp_.state();
    listed_.clear();
    const Tmc429Ramp::Steps steps = ramp_.advance(end, reach, until, listed ? &listed_ : nullptr);
    reference_.state = before;
    reference_steps_.clear();
    if (until == Tmc429Ramp::Until::velocity_changes && ramp_.now() > before.now) {
      reference_.advance(ramp_.now() - 1, reference_steps_);
      ASSERT_EQ(reference_.state.velocity, before.velocity);
      ASSERT_TRUE(ramp_.state().velocity != before.velocity || ramp_.now() == end || steps.count != 0);
    }
    reference_.advance(ramp_.now(), reference_steps_);
    ASSERT_EQ(ramp_.state(), reference_.state);
    ASSERT_EQ(steps.count, reference_steps_.size());
    if (steps.count != 0) {
      ASSERT_EQ((Tmc429RampReference::Step{steps.first_tick, steps.decreasing}), reference_steps_.front());
      ASSERT_EQ((Tmc429RampReference::Step{steps.last_tick, steps.decreasing}), reference_steps_.back());
      ASSERT_LE(steps.count, steps.decreasing ? reach.decreasing : reach.increasing);
    }
    if (listed) {
      ASSERT_TRUE(std::equal(listed_.begin(), listed_.end(), reference_steps_.begin(), reference_steps_.end(),
                             [](std::uint64_t tick, const auto& step) { return tick == step.tick; }));
      listed_steps_ += listed_.size();
    }
  }

  Dice& dice() { return mischief_.dice(); }
  void list_always() { list_always_ = true; }
  std::uint64_t listed_steps() const { return listed_steps_; }

 private:
  Mischief mischief_;
  Tmc429Ramp ramp_;
  Tmc429RampReference reference_;
  std::vector<std::uint64_t> listed_;
  std::vector<Tmc429RampReference::Step> reference_steps_;
  std::uint64_t cases_ = 0;
  std::uint64_t listed_steps_ = 0;
  bool list_always_ = false;
};

}  // namespace

/// What a failed comparison prints.
std::ostream& operator<<(std::ostream& out, const Tmc429RampState& state) {
  const Tmc429RampSettings& settings = state.settings;
  return out << "mode " << static_cast<int>(settings.mode) << " dividers " << settings.ramp_divider << ' '
             << settings.pulse_divider << " A_MAX " << settings.maximum_acceleration << " V_MIN "
             << settings.minimum_velocity << " V_MAX " << settings.maximum_velocity << " p " << settings.multiplier
             << ' ' << settings.divisor << " blocked " << state.blocked.decreasing << state.blocked.increasing
             << state.blocked.soft_stop << " X_TARGET " << settings.target_position << ": X " << state.position << " V "
             << state.velocity << "/256 A " << state.acceleration << " V_TARGET " << settings.target_velocity
             << " phase " << state.accumulator << " tick " << state.now;
}

namespace {

class Tmc429RampCases : public testing::TestWithParam<std::uint64_t> {};

constexpr std::uint64_t shards = 20;

TEST_P(Tmc429RampCases, AreTheSameInLeapsAsTickByTick) {
  constexpr std::uint64_t cases = 1'000'000 / shards;
  SideBySide pair{GetParam()};
  for (std::uint64_t i = 0; i < cases && !HasFatalFailure(); ++i) {
    const bool long_leap = i % 1000 == 999;
    pair.one_case(1 + pair.dice().of_any_length(long_leap ? 20 : 16));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Tmc429RampCases, testing::Range<std::uint64_t>(0, shards));

class Tmc429StepTicks : public testing::TestWithParam<std::uint64_t> {};

constexpr std::uint64_t listing_shards = 4;

TEST_P(Tmc429StepTicks, OfTwoMillionStepsAreThoseOfTheReference) {
  constexpr std::uint64_t steps = 8'000'000 / listing_shards;
  SideBySide pair{1000 + GetParam()};
  pair.list_always();
  while (pair.listed_steps() < steps && !HasFatalFailure()) {
    pair.one_case(1 + pair.dice().of_any_length(16));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Tmc429StepTicks, testing::Range<std::uint64_t>(0, listing_shards));

TEST(Tmc429Ramp, GivesTheStepRateOfTheFormulaToTheLastStepInAThousandSeconds) {
  // fCLK v / (2^PULSE_DIV 2048 32), page 36: 51208.496 steps/s.
  Tmc429Ramp ramp;
  ramp.configure({.mode = RampMode::hold, .pulse_divider = 3});
  ramp.set_velocity(1678);
  const auto ticks_per_second = tmc429::clock_frequency / tmc429::clock_prescaler;
  EXPECT_EQ(ramp.advance(1000 * ticks_per_second).count, 51'208'496u);
}

TEST(Tmc429Ramp, BrakesFromTheDistanceAtWhichTheLawAllowsItsVelocity) {
  // The two directions of each law, over all factors that the registers can hold.
  Tmc429RampState state;
  state.settings.maximum_velocity = 2047;
  for (const RampMode mode : {RampMode::ramp, RampMode::soft}) {
    state.settings.mode = mode;
    for (std::uint32_t divisor = 0; divisor <= 15; ++divisor) {
      state.settings.divisor = divisor;
      for (std::uint32_t multiplier = 128; multiplier <= 255; multiplier += 3) {
        state.settings.multiplier = multiplier;
        for (std::uint64_t distance = 1; distance < 1u << 20; distance += 1 + distance / 5) {
          const std::int32_t limit = state.velocity_limit(distance);
          const std::uint64_t shortest = state.shortest_distance(limit);
          ASSERT_LE(shortest, distance);
          ASSERT_EQ(state.velocity_limit(shortest), limit);
          ASSERT_TRUE(shortest == 1 || state.velocity_limit(shortest - 1) < limit);
        }
      }
    }
  }
}

TEST(Tmc429Ramp, TakesTheSquareRootRoundedDown) {
  for (std::uint64_t steps = 1; steps < 1u << 19; steps += 1 + steps / 1000) {
    // p = 1/512: v² <= 4 d.
    const auto velocity = static_cast<std::uint64_t>(tmc429_choices::braking_velocity(steps, 128, 13, 1 << 20));
    ASSERT_LE(velocity * velocity, 4 * steps);
    ASSERT_GT((velocity + 1) * (velocity + 1), 4 * steps);
  }
}

}  // namespace
}  // namespace opentmcl::twin
