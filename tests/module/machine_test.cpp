// The machine of the virtual modules as a host sees it.
#include <gtest/gtest.h>

#include "tests/module/bench.hpp"
#include "twin/physics/ideal_rotor.hpp"

namespace opentmcl::tests {
namespace {

/// @param start µm from the middle
VirtualModule::Options stage_from(std::int32_t start) {
  VirtualModule::Options options;
  std::get<twin::LinearStageDimensions>(options.machine).start = start;
  return options;
}

struct Switches {
  std::int32_t left;
  std::int32_t right;
  std::int32_t home;

  friend bool operator==(const Switches&, const Switches&) = default;
};

Switches switches(Bench& bench) {
  return {bench.get(AxisParameter::left_limit_switch_state), bench.get(AxisParameter::right_limit_switch_state),
          bench.get(AxisParameter::home_switch_state)};
}

TEST(Machine, ShowsItsSwitchesOnBothModules) {
  for (const ModuleDescription* description : {&pd1161, &tmcm1110}) {
    struct Row {
      std::int32_t place;  // µm
      Switches switches;
    };
    for (const Row& row :
         {Row{-48'500, {1, 0, 0}}, Row{-10'000, {0, 0, 1}}, Row{0, {0, 0, 0}}, Row{48'500, {0, 1, 0}}}) {
      Bench bench(*description, hal::PortKind::usb, nullptr, stage_from(row.place));
      EXPECT_EQ(switches(bench), row.switches) << description->name << " at " << row.place << " um";
    }
  }
}

TEST(Machine, IsStoppedByItsLimitSwitchesWhenTheyAreEnabled) {
  Bench bench(pd1161, hal::PortKind::usb, nullptr, stage_from(47'900));
  bench.set(AxisParameter::right_limit_switch_disable, 0);
  bench.command(Opcode::mvp, 0, 0, 100'000);
  bench.wait(5'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 2560) << "0.1 mm of 2 mm a turn";
  EXPECT_EQ(bench.module.world().rotor_angle(), 2560);
}

TEST(Machine, CannotPassItsEndsAndLosesStepsThere) {
  Bench bench(tmcm1110, hal::PortKind::usb, nullptr, stage_from(-49'900));
  bench.command(Opcode::mvp, 0, 0, -100'000);
  bench.wait_until_reached(20'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), -100'000) << "the module does not notice";
  EXPECT_GE(bench.module.world().rotor_angle(), -2560);
  bench.command(Opcode::mvp, 0, 0, -90'000);
  bench.wait_until_reached(20'000 * one_millisecond);
  EXPECT_EQ((bench.module.world().rotor_angle() + 90'000) % twin::IdealRotor::field_turn, 0);
  EXPECT_GT(bench.module.world().rotor_angle(), 0);
}

TEST(Machine, HasSwitchesThatAHandCanOpen) {
  Bench bench(pd1161);
  twin::World& world = bench.module.world();
  world.set_left_switch(true);
  world.set_home_switch(true);
  EXPECT_EQ(switches(bench), (Switches{1, 0, 1}));
  world.set_left_switch(false);
  world.set_home_switch(false);
  world.set_right_switch(true);
  EXPECT_EQ(switches(bench), (Switches{0, 1, 0}));
}

TEST(PullUps, AreOnFromTheStartAndMakeOpenSwitchesVisible) {
  Bench bench(pd1161);
  twin::World& world = bench.module.world();
  world.set_left_switch(true);
  world.set_right_switch(true);
  world.set_home_switch(true);
  EXPECT_EQ(switches(bench), (Switches{1, 1, 1}));
  EXPECT_EQ(bench.command(Opcode::sio, 0, 0, 0).status, Status::ok);
  EXPECT_EQ(switches(bench), (Switches{0, 0, 0}));
  EXPECT_EQ(bench.command(Opcode::sio, 0, 2, 1).status, Status::ok);
  EXPECT_EQ(bench.command(Opcode::sio, 255, 2, 3).status, Status::ok);
  EXPECT_EQ(switches(bench), (Switches{0, 0, 0})) << "outputs leave them alone";
  EXPECT_EQ(bench.command(Opcode::sio, 0, 0, 1).status, Status::ok);
  EXPECT_EQ(switches(bench), (Switches{1, 1, 1}));
}

TEST(PullUps, OfTheTmcm1110CannotBeSwitched) {
  Bench bench(tmcm1110);
  bench.module.world().set_home_switch(true);
  bench.command(Opcode::sio, 255, 2, 0);
  EXPECT_EQ(bench.command(Opcode::sio, 0, 0, 0).status, Status::wrong_type);
  EXPECT_EQ(bench.get(AxisParameter::home_switch_state), 1);
}

TEST(HomeSwitch, OfTheTmcm1110IsInput0) {
  Bench bench(tmcm1110, hal::PortKind::usb, nullptr, stage_from(-10'000));
  EXPECT_EQ(bench.command(Opcode::gio, 0, 0).value, 1);
  Bench other(pd1161, hal::PortKind::usb, nullptr, stage_from(-10'000));
  EXPECT_EQ(other.command(Opcode::gio, 0, 0).value, 0);
}

TEST(EncoderNull, ShowsOnThePd1161WithinAFullStep) {
  Bench bench(pd1161);
  constexpr std::int32_t turn = 51'200;
  for (const auto& [position, is_near] : {std::pair{0, 1}, {2 * turn - 250, 1}, {turn + 500, 0}, {turn / 2, 0}}) {
    bench.command(Opcode::mvp, 0, 0, position);
    bench.wait_until_reached(20'000 * one_millisecond);
    EXPECT_EQ(bench.command(Opcode::gio, 11, 0).value, is_near) << position;
  }
}

}  // namespace
}  // namespace opentmcl::tests
