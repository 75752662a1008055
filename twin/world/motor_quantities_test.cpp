// What can be written changes the physics that it names, and what can be looked at is that of the present.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "twin/world/quantities.hpp"
#include "twin/world/world_test_bench.hpp"

namespace opentmcl::twin {
namespace {

double value_of(const World& world, std::string_view name) {
  return find_quantity(name)->read(world);
}

void change(World& world, std::string_view name, double value) {
  const Quantity& quantity = *find_quantity(name);
  ASSERT_EQ(refusal(quantity, world, value), std::nullopt) << name;
  quantity.write(world, value);
}

World::Mounted bench() {
  return {.machine = LinearStageDimensions{}, .motor = motors().front()};
}

void drive(World& world, std::int32_t velocity) {
  write(world, tmc429::Mode::of(tmc429::RampMode::velocity));
  set<tmc429::MaximumVelocity>(world, std::abs(velocity));
  set<tmc429::TargetVelocity>(world, velocity);
}

struct Change {
  std::string_view name;
  double value;
};

/// Half a second after a change to what stands, while the motor accelerates, another quantity is greater or less.
struct Effect {
  Change change;
  std::string_view probe;
  bool is_greater;
  std::optional<Change> given = {};
};

const std::vector<Effect> effects{
    {{"supply_voltage", 10}, "load_measurement", true},
    {{"temperature", 160}, "tmc262.bridges_on", false},
    {{"load.torque", 0.05}, "rotor.load_angle", true},
    {{"load.pull", 100}, "rotor.load_angle", true},
    {{"load.inertia", 5e-3}, "rotor.load_angle", true},
    {{"load.coulomb_friction", 0.05}, "rotor.load_angle", true},
    {{"load.viscous_friction", 0.01}, "rotor.load_angle", true},
    {{"load.spring", 0.1}, "rotor.load_angle", true},
    {{"load.spring_centre", -30}, "rotor.load_angle", true, Change{"load.spring", 0.1}},
    {{"load.jammed", 1}, "rotor.angle", false},
    {{"step_direction.rate", -5'000}, "rotor.angle", false},
    {{"motor.ambient_temperature", 90}, "motor.winding_temperature", true},
    {{"coil_a.connected", 0}, "tmc262.open_load_a", true},
    {{"coil_b.connected", 0}, "tmc262.open_load_b", true},
    {{"coil_a.shorted", 1}, "tmc262.short_to_ground_a", true},
    {{"coil_b.shorted", 1}, "tmc262.short_to_ground_b", true},
    {{"encoder.a_connected", 0}, "encoder", false},
    {{"encoder.b_connected", 0}, "encoder", false},
    {{"left_switch.held_open", 1}, "left_switch", true},
    {{"right_switch.held_open", 1}, "right_switch", true},
    {{"home_switch.held_open", 1}, "home_switch", true},
    {{"left_switch.pressed", 1}, "left_switch", true},
    {{"right_switch.pressed", 1}, "right_switch", true},
    {{"home_switch.pressed", 1}, "home_switch", true},
};

double probed(const Effect& effect, bool is_changed) {
  World world(nullptr, bench());
  start_with_current(world);
  if (effect.given) change(world, effect.given->name, effect.given->value);
  if (is_changed) change(world, effect.change.name, effect.change.value);
  set<tmc429::MaximumAcceleration>(world, 5);
  drive(world, 1500);
  world.advance_to(520 * millisecond);
  return value_of(world, effect.probe);
}

TEST(WritableQuantities, ChangeWhatTheySay) {
  for (const Effect& effect : effects) {
    const double before = probed(effect, false);
    const double after = probed(effect, true);
    EXPECT_TRUE(effect.is_greater ? after > before : after < before)
        << effect.change.name << ": " << effect.probe << " was " << before << ", is " << after;
  }
}

TEST(WritableQuantities, HaveAnEffectThatIsTested) {
  const World world(nullptr, bench());
  for (const Quantity& quantity : quantities()) {
    const bool is_input = quantity.name.starts_with("input.") || quantity.name.starts_with("analog_input.") ||
                          quantity.name == "step_direction.enable";
    const bool is_index_wire = quantity.name == "encoder.n_connected";
    if (is_input || is_index_wire || !quantity.can_be_written() || refusal(quantity, world, quantity.lowest)) continue;
    const bool is_tested = std::any_of(effects.begin(), effects.end(),
                                       [&](const Effect& effect) { return effect.change.name == quantity.name; });
    EXPECT_TRUE(is_tested) << quantity.name;
  }
}

TEST(WritableQuantities, TakeTheIndexAwayWithItsWire) {
  const auto sees_index = [](bool has_wire) {
    World world(nullptr, bench());
    start_with_current(world);
    change(world, "encoder.n_connected", has_wire ? 1 : 0);
    static_cast<void>(world.encoder().take_null_event(false));
    set<tmc429::TargetPosition>(world, 60'000);
    world.advance_to(4000 * millisecond);
    return world.encoder().take_null_event(false).has_value();
  };
  EXPECT_TRUE(sees_index(true));
  EXPECT_FALSE(sees_index(false));
}

TEST(Quantities, ShowTheMotorAsItIsNow) {
  World world(nullptr, bench());
  start_with_current(world);
  change(world, "load.coulomb_friction", 0.1);
  set<tmc429::MaximumAcceleration>(world, 50);
  drive(world, 1000);
  world.advance_to(3000 * millisecond);
  const double speed = value_of(world, "rotor.speed");
  EXPECT_NEAR(speed, value_of(world, "step_rate") / microsteps_per_turn * 60, 0.5);
  EXPECT_EQ(value_of(world, "rotor.regime"), 0);
  EXPECT_EQ(value_of(world, "rotor.lost_steps"), 0);
  EXPECT_GT(value_of(world, "rotor.load_angle"), 10);
  EXPECT_LT(value_of(world, "rotor.load_angle"), 90);
  EXPECT_GT(value_of(world, "motor.torque"), 0.1);
  EXPECT_LT(value_of(world, "motor.torque"), value_of(world, "motor.pull_out_torque"));
  EXPECT_NEAR(std::hypot(value_of(world, "coil_a.current"), value_of(world, "coil_b.current")),
              value_of(world, "tmc262.current_amplitude"), 1e-3);

  // Within a span of 10 ms too.
  const double angle = value_of(world, "rotor.angle");
  const double encoder = value_of(world, "encoder");
  const double stage = value_of(world, "stage");
  world.advance_to(world.now() + 3 * millisecond);
  const double turned = speed / 60 * 0.003 * 360;  // degrees
  EXPECT_NEAR(value_of(world, "rotor.angle") - angle, turned, 0.1);
  EXPECT_NEAR(value_of(world, "encoder") - encoder, turned / 360 * 1024, 1.5);
  EXPECT_NEAR(value_of(world, "stage") - stage, turned / 360 * 2, 0.002);
}

TEST(Quantities, CountTheStepsThatAreLost) {
  World world(nullptr, bench());
  start_with_current(world);
  change(world, "load.jammed", 1);
  set<tmc429::TargetPosition>(world, 10 * microsteps_per_electrical_turn);
  world.advance_to(2000 * millisecond);
  EXPECT_EQ(value_of(world, "rotor.lost_steps"), 40);
  EXPECT_EQ(value_of(world, "rotor.angle"), 0);
}

TEST(Quantities, CountTheStepsThatAnIdealMotorLosesAtAnEnd) {
  LinearStageDimensions stage;
  stage.start = 50'000;
  World world(nullptr, {.machine = stage});
  start(world);
  set<tmc429::TargetPosition>(world, 10 * microsteps_per_electrical_turn);
  world.advance_to(2000 * millisecond);
  EXPECT_EQ(value_of(world, "position"), 10 * microsteps_per_electrical_turn);
  EXPECT_EQ(value_of(world, "rotor.lost_steps"), 40);
}

/// A contact that chatters does so from the finger on, at its own ticks, however time is cut.
TEST(PressedSwitch, ChattersAtItsOwnTicks) {
  const auto changes = [](Tick slice) {
    LinearStageDimensions stage;
    stage.switch_bounce = 3'000;
    TraceText trace;
    World world(&trace, {.machine = stage, .motor = motors().front()});
    start_with_current(world);
    change(world, "home_switch.pressed", 1);
    const Tick end = world.now() + 20 * millisecond;
    while (world.now() < end) world.advance_to(std::min(end, world.now() + slice));
    EXPECT_EQ(value_of(world, "home_switch"), 1);
    return trace.text();
  };
  const std::string whole = changes(1'000 * millisecond);
  EXPECT_GT(std::count(whole.begin(), whole.end(), '\n'), 3);
  EXPECT_EQ(changes(777), whole);
}

/// A short does not take the time before it from the motor.
TEST(ShortToGround, ActsFromItsTickOn) {
  const auto angle_after = [](bool shorted) {
    World world(nullptr, bench());
    start_with_current(world);
    drive(world, 1500);
    world.advance_to(2000 * millisecond + 5 * millisecond);
    if (shorted) change(world, "coil_a.shorted", 1);
    return value_of(world, "rotor.angle");
  };
  EXPECT_NEAR(angle_after(true), angle_after(false), 1e-6);
}

}  // namespace
}  // namespace opentmcl::twin
