#include "twin/world/quantities.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "twin/physics/shaft.hpp"
#include "twin/world/world_test_bench.hpp"

namespace opentmcl::twin {
namespace {

World::Mounted stage_at(std::int32_t start, std::optional<MotorData> motor = std::nullopt) {
  LinearStageDimensions dimensions;
  dimensions.start = start;
  return {.machine = dimensions, .motor = motor};
}

/// With an ideal motor and with a real one.
const std::array<World::Mounted, 2> benches{stage_at(0), stage_at(0, motors().front())};

double value_of(const World& world, std::string_view name) {
  return find_quantity(name)->read(world);
}

void change(World& world, std::string_view name, double value) {
  find_quantity(name)->write(world, value);
}

bool can_be_written(const Quantity& quantity, const World& world) {
  return quantity.can_be_written() && !refusal(quantity, world, quantity.lowest);
}

/// Values that a quantity can be given: both ends, the middle, and one a little above the lowest.
std::vector<double> values_for(const Quantity& quantity) {
  if (quantity.kind == Quantity::Kind::truth) return {1, 0};
  return {quantity.lowest, quantity.lowest + 1, std::trunc((quantity.lowest + quantity.highest) / 2), quantity.highest};
}

TEST(Quantities, HaveARangeExactlyWhereTheyCanBeWritten) {
  for (const Quantity& quantity : quantities())
    EXPECT_EQ(quantity.can_be_written(), quantity.lowest < quantity.highest) << quantity.name;
}

TEST(Quantities, HoldWhatWasWritten) {
  for (const World::Mounted& bench : benches) {
    for (const Quantity& quantity : quantities()) {
      World world(nullptr, bench);
      if (!can_be_written(quantity, world)) continue;
      for (const double value : values_for(quantity)) {
        ASSERT_EQ(refusal(quantity, world, value), std::nullopt) << quantity.name;
        quantity.write(world, value);
        EXPECT_NEAR(quantity.read(world), value, 1e-9) << quantity.name;
      }
    }
  }
}

/// Whether `other` says in another way what `written` says.
bool follows(std::string_view other, std::string_view written) {
  const auto is_one_torque = [](std::string_view name) { return name == "load.torque" || name == "load.pull"; };
  if (written == "temperature" && other.starts_with("tmc262.overtemperature")) return true;
  return other == "inputs" || written.starts_with(other) || (is_one_torque(other) && is_one_torque(written));
}

TEST(Quantities, AreOneThingEach) {
  for (const World::Mounted& bench : benches) {
    for (const Quantity& written : quantities()) {
      World world(nullptr, bench);
      if (!can_be_written(written, world)) continue;
      const double before = written.read(world);
      const double value = before == written.highest ? written.lowest : written.highest;
      std::vector<std::pair<const Quantity*, double>> others;
      for (const Quantity& other : quantities()) {
        if (other.exists_in(world) && !follows(other.name, written.name))
          others.emplace_back(&other, other.read(world));
      }
      written.write(world, value);
      for (const auto& [other, former] : others)
        EXPECT_EQ(other->read(world), former) << written.name << " changed " << other->name;
    }
  }
}

TEST(Quantities, HaveTheValuesOfTheTraceInTheirUnits) {
  struct Watch : TraceObserver {
    void changed(Tick, std::string_view signal, std::int64_t value) override {
      const Quantity* const quantity = find_quantity(signal);
      const auto& only = trace_only_signals();
      const bool is_event = std::any_of(only.begin(), only.end(), [&](const auto& row) { return row.name == signal; });
      EXPECT_NE(quantity != nullptr && quantity->trace_scale != 0, is_event) << signal;
      if (quantity != nullptr) latest[quantity] = static_cast<double>(value) / quantity->trace_scale;
    }
    std::map<const Quantity*, double> latest;
  } watch;
  World world(&watch, stage_at(-9'495));
  start(world);
  set<tmc429::TargetVelocity>(world, -1000);
  set<tmc429::TargetPosition>(world, -3000);
  world.advance_to(100 * millisecond);
  change(world, "supply_voltage", 23.456);
  change(world, "temperature", 60);
  change(world, "input.3", 1);
  change(world, "right_switch.pressed", 1);
  change(world, "left_switch.held_open", 1);
  world.set_outputs(5);
  world.set_driver_disable(true);
  EXPECT_GE(watch.latest.size(), 10u);
  for (const auto& [quantity, value] : watch.latest) EXPECT_NEAR(quantity->read(world), value, 1e-9) << quantity->name;
}

TEST(Quantities, AreInHumanUnits) {
  World world(nullptr, stage_at(0));
  start(world);
  set<tmc429::TargetPosition>(world, microsteps_per_turn);
  world.advance_to(3000 * millisecond);
  EXPECT_EQ(value_of(world, "position"), 51'200);
  EXPECT_EQ(value_of(world, "rotor.angle"), 360);
  EXPECT_EQ(value_of(world, "stage"), 2);
  EXPECT_EQ(value_of(world, "encoder"), 1024);
}

TEST(Quantities, KnowTheStepRate) {
  World world;
  start(world);
  write(world, tmc429::Mode::of(tmc429::RampMode::velocity));
  write(world, tmc429::Dividers::Pulse::of(3) | tmc429::Dividers::Ramp::of(3));
  set<tmc429::MaximumVelocity>(world, 2047);
  set<tmc429::TargetVelocity>(world, -1678);
  world.advance_to(3000 * millisecond);
  EXPECT_EQ(value_of(world, "velocity"), -1678);
  EXPECT_NEAR(value_of(world, "step_rate"), -51'208.5, 0.01);
}

TEST(Quantities, ExistOnlyOnTheMachineThatHasThem) {
  EXPECT_FALSE(find_quantity("stage")->exists_in(World()));
  EXPECT_TRUE(find_quantity("stage")->exists_in(World(nullptr, stage_at(0))));
  EXPECT_FALSE(find_quantity("table")->exists_in(World(nullptr, stage_at(0))));
  EXPECT_EQ(find_quantity("stages"), nullptr);
}

TEST(Quantities, ShowTheAngleOfATable) {
  CircularAxisDimensions table;
  table.start = 12'500;
  const World world(nullptr, {.machine = table});
  EXPECT_TRUE(find_quantity("table")->exists_in(world));
  EXPECT_EQ(value_of(world, "table"), 12.5);
}

TEST(Quantities, SayWhyTheyCannotBeWritten) {
  const World world;
  const auto reason = [&world](std::string_view name, double value) {
    return refusal(*find_quantity(name), world, value).value_or("");
  };
  EXPECT_EQ(reason("position", 0), "can only be looked at");
  EXPECT_EQ(reason("stage", 0), "does not exist on this machine");
  EXPECT_EQ(reason("supply_voltage", 61), "goes from 0 to 60 V");
  EXPECT_EQ(reason("supply_voltage", std::nan("")), "goes from 0 to 60 V");
  EXPECT_EQ(reason("load_measurement", -1'024), "goes from -1023 to 1023");
  EXPECT_EQ(reason("load.torque", 0.1), "does not exist with an ideal motor");
  EXPECT_EQ(reason("load_measurement", 0.5), "is a whole number");
  EXPECT_EQ(reason("input.0", 0.5), "is 0 or 1");
  EXPECT_EQ(reason("supply_voltage", 23.5), "");

  const World real(nullptr, {.motor = motors().front()});
  EXPECT_EQ(refusal(*find_quantity("load_measurement"), real, 0), "can only be set with an ideal motor");
  EXPECT_EQ(refusal(*find_quantity("load.pull"), real, 0), "does not exist on this machine");
  EXPECT_EQ(refusal(*find_quantity("home_switch.pressed"), real, 1), "does not exist on this machine");
}

TEST(Quantities, ChangeNothingWhenLookedAt) {
  const auto trace_of = [](const std::optional<MotorData>& motor, bool looked_at) {
    TraceText trace;
    World world(&trace, stage_at(-47'900, motor));
    start(world);
    set<tmc429::TargetPosition>(world, -5000);
    for (int i = 1; i < 100; ++i) {
      world.advance_to(static_cast<Tick>(i) * millisecond);
      if (looked_at) {
        for (const Quantity& quantity : quantities()) {
          if (quantity.exists_in(world)) quantity.read(world);
        }
      }
    }
    return trace.text();
  };
  EXPECT_EQ(trace_of(std::nullopt, false), trace_of(std::nullopt, true));
  EXPECT_EQ(trace_of(motors().front(), false), trace_of(motors().front(), true));
}

RC_GTEST_PROP(TextOfAValue, ReadsBackAsTheSameValue, (double value)) {
  RC_ASSERT(std::stod(text_of(value)) == value);
}

}  // namespace
}  // namespace opentmcl::twin
