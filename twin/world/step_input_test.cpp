#include "twin/world/step_input.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include "twin/world/world_test_bench.hpp"

namespace opentmcl::twin {
namespace {

constexpr Tick second = 1000 * millisecond;

RC_GTEST_PROP(StepInput, GivesAsManyPulsesASecondAsWereAskedFor, ()) {
  const int rate = *rc::gen::inRange(1, 20'000);
  const Tick begin = *rc::gen::inRange<Tick>(0, 10 * second);
  StepInput input;
  input.set_rate(rate, begin);
  Tick before = begin;
  for (int pulse = 0; pulse < rate; ++pulse) {
    RC_ASSERT(input.next() > before);
    before = input.next();
    input.take();
  }
  RC_ASSERT(before < begin + second);
  RC_ASSERT(input.next() > begin + second);
}

TEST(StepInput, IsSilentWithoutARate) {
  StepInput input;
  EXPECT_EQ(input.next(), never_tick);
  input.set_rate(100, 0);
  input.set_rate(0, 5);
  EXPECT_EQ(input.next(), never_tick);
}

struct PulsedShaft : testing::Test {
  static std::unique_ptr<World> world_with(const std::optional<MotorData>& motor) {
    auto world = std::make_unique<World>(nullptr, World::Mounted{.machine = RotaryAxisDimensions{}, .motor = motor});
    start_with_current(*world);
    return world;
  }
};

TEST_F(PulsedShaft, TurnsAsFarAsItIsPulsed) {
  const auto world = world_with(std::nullopt);
  world->set_step_input_rate(1000);
  world->advance_to(world->now() + second);
  EXPECT_EQ(world->rotor_angle(), 1000);
  world->set_step_input_rate(-500);
  world->advance_to(world->now() + second);
  EXPECT_EQ(world->rotor_angle(), 500);
  world->set_step_input_rate(0);
  world->advance_to(world->now() + second);
  EXPECT_EQ(world->rotor_angle(), 500);
}

TEST_F(PulsedShaft, TakesARealMotorAlong) {
  const auto world = world_with(motors().front());
  world->set_step_input_rate(12'800);
  world->advance_to(world->now() + second);
  EXPECT_NEAR(static_cast<double>(world->rotor_angle()), 12'800, 64);
  world->set_step_input_rate(0);
  world->advance_to(world->now() + second);
  EXPECT_NEAR(static_cast<double>(world->rotor_angle()), 12'800, 32);
}

TEST_F(PulsedShaft, StaysBehindPulsesThatItCannotFollow) {
  const auto turned = [](double inertia) {
    World world(nullptr, {.machine = RotaryAxisDimensions{.inertia = inertia}, .motor = motors().front()});
    start_with_current(world);
    world.set_step_input_rate(50'000);
    world.advance_to(world.now() + second);
    return world.rotor_angle();
  };
  EXPECT_NEAR(static_cast<double>(turned(0)), 50'000, 256) << "within the start-stop region of the motor alone";
  EXPECT_LT(turned(1e-3), 10'000);
}

RC_GTEST_FIXTURE_PROP(PulsedShaft, DoesNotCareHowTimeIsCut, ()) {
  const double rate = *rc::gen::inRange(-20'000, 20'000);
  const auto cuts = *rc::gen::container<std::vector<Tick>>(20, rc::gen::inRange<Tick>(1, 20 * millisecond));
  const auto cut = world_with(motors().front());
  const auto whole = world_with(motors().front());
  for (World* world : {cut.get(), whole.get()}) world->set_step_input_rate(rate);
  for (const Tick length : cuts) cut->advance_to(cut->now() + length);
  whole->advance_to(cut->now());
  RC_ASSERT(cut->rotor_angle() == whole->rotor_angle());
  RC_ASSERT(cut->present_motor()->state().velocity == whole->present_motor()->state().velocity);
}

}  // namespace
}  // namespace opentmcl::twin
