#include "twin/physics/machine.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace opentmcl::twin {
namespace {

constexpr MachineSwitch all_switches[] = {MachineSwitch::left, MachineSwitch::right, MachineSwitch::home};

/// Shaft angle at a place of the default stage, µm from the middle: 2 mm a turn.
constexpr std::int64_t angle_at(std::int64_t place) {
  return place * microsteps_per_turn / 2000;
}

struct Open {
  bool left;
  bool right;
  bool home;

  friend bool operator==(const Open&, const Open&) = default;
};

/// A machine on its way, and the contacts as they are at `tick`, long after any chatter.
struct Walk {
  explicit Walk(const MachineDimensions& dimensions) : machine(dimensions) {}

  void to(std::int64_t angle) { machine.follow(angle, tick += 1'000'000); }
  Open open() {
    tick += 1'000'000;
    return {machine.is_open(MachineSwitch::left, tick), machine.is_open(MachineSwitch::right, tick),
            machine.is_open(MachineSwitch::home, tick)};
  }
  Open open_at(std::int64_t angle) {
    to(angle);
    return open();
  }

  Machine machine;
  Tick tick = 0;
};

// ---- The default machine

TEST(LinearStage, HasItsSwitchesWhereTheDefaultMachineHasThem) {
  Walk stage{LinearStageDimensions{}};
  EXPECT_EQ(stage.machine.travel(), (AngleRange{angle_at(-50'000), angle_at(50'000)}));
  EXPECT_EQ(stage.machine.place_unit(), PlaceUnit::micrometre);
  struct Row {
    std::int64_t place;  // µm
    Open open;
  };
  const Row rows[] = {
      {-50'000, {false, false, false}}, {-49'000, {true, false, false}},  {-48'000, {true, false, false}},
      {-47'000, {false, false, false}}, {-11'000, {false, false, false}}, {-10'500, {false, false, true}},
      {-9'500, {false, false, true}},   {-9'000, {false, false, false}},  {0, {false, false, false}},
      {47'000, {false, false, false}},  {48'000, {false, true, false}},   {49'000, {false, true, false}},
      {50'000, {false, false, false}},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(stage.open_at(angle_at(row.place)), row.open) << row.place << " um";
    EXPECT_EQ(stage.machine.place(), row.place);
  }
}

TEST(LinearStage, SwitchesWithinOneMicrostep) {
  Walk stage{LinearStageDimensions{}};
  EXPECT_TRUE(stage.open_at(angle_at(-48'000)).left);
  EXPECT_FALSE(stage.open_at(angle_at(-48'000) + 1).left);
  EXPECT_TRUE(stage.open_at(angle_at(-49'000)).left);
  EXPECT_FALSE(stage.open_at(angle_at(-49'000) - 1).left);
}

TEST(LinearStage, StartsWhereItIsTold) {
  LinearStageDimensions dimensions;
  dimensions.start = -48'500;
  Walk stage(dimensions);
  EXPECT_EQ(stage.machine.place(), -48'500);
  EXPECT_EQ(stage.open(), (Open{true, false, false})) << "stands on the switch";
  EXPECT_EQ(stage.machine.next_chatter(0), never_tick);
  EXPECT_EQ(stage.machine.travel().lowest, angle_at(-1'500));
}

TEST(LinearStage, MovesTheOtherWayWithTheMotorAtTheOtherEnd) {
  LinearStageDimensions dimensions;
  dimensions.mirrored = true;
  Walk stage(dimensions);
  EXPECT_TRUE(stage.open_at(angle_at(48'500)).left);
  EXPECT_TRUE(stage.open_at(angle_at(-48'500)).right);
  EXPECT_TRUE(stage.open_at(angle_at(10'000)).home);
  EXPECT_EQ(stage.machine.place(), -10'000);
  EXPECT_LT(stage.machine.torque_of(1.0), 0.0);
}

TEST(LinearStage, OpensNormallyOpenContactsAwayFromTheSwitches) {
  LinearStageDimensions dimensions;
  dimensions.contact = Contact::normally_open;
  Walk stage(dimensions);
  EXPECT_EQ(stage.open_at(0), (Open{true, true, true}));
  EXPECT_EQ(stage.open_at(angle_at(48'500)), (Open{true, false, true}));
}

TEST(LinearStage, TurnsForceAndMassOfTheSliderIntoTorqueAndInertiaOfTheShaft) {
  LinearStageDimensions dimensions;
  dimensions.pitch = 10'000;  // 1.5915 mm a rad
  dimensions.moved_mass = 2.0;
  dimensions.screw_inertia = 3e-6;
  dimensions.friction = 10.0;
  dimensions.end_stiffness = 1e7;
  const Machine stage(dimensions);
  EXPECT_NEAR(stage.torque_of(100.0), 0.15915, 1e-5);
  EXPECT_NEAR(stage.inertia(), 3e-6 + 2.0 * 2.5330e-6, 1e-9);
  EXPECT_NEAR(stage.friction(), 0.015915, 1e-6);
  EXPECT_NEAR(stage.end_stiffness(), 25.330, 1e-3);
}

// ---- A free shaft

TEST(RotaryAxis, HasAllSwitchInputsWiredToGroundAndNoEnd) {
  Walk axis{RotaryAxisDimensions{.inertia = 2e-5, .friction = 0.01}};
  EXPECT_EQ(axis.open_at(1'000'000'000), (Open{false, false, false}));
  EXPECT_EQ(axis.machine.travel(), AngleRange{});
  EXPECT_EQ(axis.machine.next_event_distance(0), EventDistance{});
  axis.machine.press(MachineSwitch::left, true, axis.tick);
  EXPECT_FALSE(axis.open().left) << "there is nothing to press";
  axis.machine.break_wire(MachineSwitch::left, true);
  EXPECT_TRUE(axis.open().left);
  EXPECT_EQ(axis.machine.inertia(), 2e-5);
  EXPECT_EQ(axis.machine.friction(), 0.01);
  EXPECT_EQ(axis.machine.torque_of(0.5), 0.5);
}

TEST(RotaryAxis, CountsThousandthsOfADegree) {
  Walk axis{RotaryAxisDimensions{}};
  axis.to(microsteps_per_turn * 5 / 4);
  EXPECT_EQ(axis.machine.place(), 450'000);
  EXPECT_EQ(axis.machine.place_unit(), PlaceUnit::millidegree);
}

// ---- A table behind a gear

TEST(CircularAxis, MeetsItsHomeMarkOnceInEveryTurnOfTheTable) {
  Walk axis{CircularAxisDimensions{}};  // 10 : 1, the mark from 87.5 to 92.5 degrees
  const std::int64_t table_turn = 10 * microsteps_per_turn;
  for (const std::int64_t turn : {0, 1, 7, -1, -1'000'000}) {
    const std::int64_t begin = turn * table_turn + table_turn * 87'500 / 360'000;
    EXPECT_FALSE(axis.open_at(begin).home) << "87.5 degrees lie between two microsteps";
    EXPECT_TRUE(axis.open_at(begin + 1).home) << turn;
    EXPECT_TRUE(axis.open_at(turn * table_turn + table_turn / 4).home);
    EXPECT_FALSE(axis.open_at(turn * table_turn + table_turn * 93 / 360).home);
    EXPECT_EQ(axis.open(), (Open{false, false, false}));
  }
}

TEST(CircularAxis, CountsTheTurnsOfItsTableAndNotThoseOfTheMotor) {
  CircularAxisDimensions dimensions;
  dimensions.gear_numerator = 7;
  dimensions.gear_denominator = 3;
  dimensions.start = 10'000;
  Walk axis(dimensions);
  axis.to(7 * microsteps_per_turn);
  EXPECT_EQ(axis.machine.place(), 10'000 + 3 * 360'000);
  EXPECT_EQ(axis.machine.travel(), AngleRange{}) << "endless";
}

TEST(CircularAxis, FeelsItsTableThroughTheGear) {
  CircularAxisDimensions dimensions;
  dimensions.gear_numerator = 20;
  dimensions.table_inertia = 4e-3;
  dimensions.gear_inertia = 1e-6;
  dimensions.friction = 0.4;
  const Machine axis(dimensions);
  EXPECT_NEAR(axis.inertia(), 1.1e-5, 1e-12);
  EXPECT_NEAR(axis.friction(), 0.02, 1e-12);
  EXPECT_NEAR(axis.torque_of(3.0), 0.15, 1e-12);
}

// ---- Faults and fingers

TEST(Machine, LetsAFingerHoldASwitchOnTopOfTheMachine) {
  for (const Contact contact : {Contact::normally_closed, Contact::normally_open}) {
    LinearStageDimensions dimensions;
    dimensions.contact = contact;
    const bool open_when_held = contact == Contact::normally_closed;
    Walk stage(dimensions);
    stage.machine.press(MachineSwitch::home, true, stage.tick);
    EXPECT_EQ(stage.open().home, open_when_held);
    stage.to(angle_at(-10'000));
    stage.machine.press(MachineSwitch::home, false, stage.tick);
    EXPECT_EQ(stage.open().home, open_when_held) << "the slider holds it now";
    EXPECT_EQ(stage.open_at(0).home, !open_when_held);
  }
}

TEST(Machine, ReadsABrokenWireAsOpenWhateverTheContactDoes) {
  LinearStageDimensions dimensions;
  dimensions.contact = Contact::normally_open;
  Walk stage(dimensions);
  stage.machine.break_wire(MachineSwitch::home, true);
  EXPECT_TRUE(stage.open_at(angle_at(-10'000)).home);
  stage.machine.break_wire(MachineSwitch::home, false);
  EXPECT_FALSE(stage.open().home);
}

// ---- Properties

rc::Gen<LinearStageDimensions> any_stage() {
  return rc::gen::exec([] {
    LinearStageDimensions stage;
    stage.pitch = *rc::gen::inRange(500, 20'000);
    stage.travel = 2 * *rc::gen::inRange(5'000, 20'000);
    stage.start = *rc::gen::inRange(-stage.travel / 2, stage.travel / 2 + 1);
    stage.mirrored = *rc::gen::arbitrary<bool>();
    stage.limit_switch_distance = *rc::gen::inRange(1'000, 3'000);
    stage.limit_switch_width = *rc::gen::inRange(100, stage.limit_switch_distance - 100);
    stage.home_switch_center = *rc::gen::inRange(-1'000, 1'000);
    stage.home_switch_width = 2 * *rc::gen::inRange(50, 500);
    stage.contact = *rc::gen::element(Contact::normally_closed, Contact::normally_open);
    // So little that a limit switch is let go before the end behind it.
    const int room = stage.limit_switch_distance - stage.limit_switch_width - 50;
    stage.switch_hysteresis = *rc::gen::element(0, *rc::gen::inRange(0, std::min(room, 400)));
    stage.switch_bounce = *rc::gen::element(0, 5'000);
    stage.backlash = *rc::gen::element(0, *rc::gen::inRange(0, 300));
    return stage;
  });
}

rc::Gen<CircularAxisDimensions> any_axis() {
  return rc::gen::exec([] {
    CircularAxisDimensions axis;
    axis.gear_numerator = *rc::gen::inRange(1, 100);
    axis.gear_denominator = *rc::gen::inRange(1, 10);
    axis.start = *rc::gen::inRange(-400'000, 400'000);
    axis.mirrored = *rc::gen::arbitrary<bool>();
    axis.home_mark_center = *rc::gen::inRange(0, 360'000);
    axis.home_mark_width = 2 * *rc::gen::inRange(500, 20'000);
    axis.switch_hysteresis = *rc::gen::element(0, *rc::gen::inRange(0, 2'000));
    axis.switch_bounce = *rc::gen::element(0, 5'000);
    axis.backlash = *rc::gen::element(0, *rc::gen::inRange(0, 5'000));
    return axis;
  });
}

rc::Gen<MachineDimensions> any_machine() {
  return rc::gen::oneOf(rc::gen::map(any_stage(), [](const auto& stage) { return MachineDimensions(stage); }),
                        rc::gen::map(any_axis(), [](const auto& axis) { return MachineDimensions(axis); }));
}

/// Of a stage, in units of 1/microsteps_per_turn µm, which no rounding touches.
struct ExactStage {
  explicit ExactStage(const LinearStageDimensions& d) : dimensions(d) {}

  std::int64_t place_of(std::int64_t driven) const {
    return dimensions.start * microsteps_per_turn + driven * dimensions.pitch;
  }
  static bool within(std::int64_t place, std::int64_t from, std::int64_t to) {
    return from * microsteps_per_turn <= place && place <= to * microsteps_per_turn;
  }
  bool holds(MachineSwitch name, std::int64_t place) const {
    const std::int64_t near = dimensions.travel / 2 - dimensions.limit_switch_distance;
    const std::int64_t far = near + dimensions.limit_switch_width;
    if (name == MachineSwitch::left) return within(place, -far, -near);
    if (name == MachineSwitch::right) return within(place, near, far);
    const std::int64_t half = dimensions.home_switch_width / 2;
    return within(place, dimensions.home_switch_center - half, dimensions.home_switch_center + half);
  }

  LinearStageDimensions dimensions;
};

RC_GTEST_PROP(LinearStage, HoldsASwitchExactlyWhileTheSliderIsWithinItsWidth, ()) {
  LinearStageDimensions dimensions = *any_stage();
  dimensions.switch_hysteresis = 0;
  dimensions.backlash = 0;
  const ExactStage exact(dimensions);
  Walk stage(dimensions);
  const AngleRange travel = stage.machine.travel();
  const auto angle = *rc::gen::inRange(travel.lowest, travel.highest + 1);
  const std::int64_t place = exact.place_of(dimensions.mirrored ? -angle : angle);
  stage.to(angle);
  for (const MachineSwitch name : all_switches) {
    const bool open_when_held = dimensions.contact == Contact::normally_closed;
    RC_ASSERT(stage.machine.is_open(name, stage.tick + 1'000'000) == (exact.holds(name, place) == open_when_held));
  }
  RC_ASSERT(stage.machine.place() == floor_quotient(place, microsteps_per_turn));
  RC_ASSERT(ExactStage::within(place, -dimensions.travel / 2, dimensions.travel / 2));
}

/// Walks from event to event through the whole travel, and looks at each place where a switch changes.
RC_GTEST_PROP(LinearStage, PressesAndReleasesEachSwitchWhereItsDimensionsSay, ()) {
  const LinearStageDimensions dimensions = *any_stage();
  Walk stage(dimensions);
  const AngleRange travel = stage.machine.travel();
  const bool upwards = *rc::gen::arbitrary<bool>();
  const bool rightwards = upwards != dimensions.mirrored;
  stage.to(upwards ? travel.lowest : travel.highest);
  std::int64_t angle = upwards ? travel.lowest : travel.highest;
  std::vector<std::int64_t> changes[machine_switch_count];  // places, 1/microsteps_per_turn µm
  const auto& state = stage.machine.state();
  while (angle != (upwards ? travel.highest : travel.lowest)) {
    const EventDistance distance = stage.machine.next_event_distance(angle);
    const std::int64_t step = upwards ? distance.up : distance.down;
    RC_ASSERT(step > 0);
    if (step > 1) {
      const auto before = state.switches;
      stage.to(angle + (upwards ? step - 1 : 1 - step));
      RC_ASSERT(state.switches == before);
    }
    const auto before = state.switches;
    angle += upwards ? step : -step;
    stage.to(angle);
    for (std::size_t i = 0; i < machine_switch_count; ++i) {
      if (before[i].held_by_machine != state.switches[i].held_by_machine) {
        changes[i].push_back(ExactStage(dimensions).place_of(state.driven));
      }
    }
  }
  // The slider is at the end of its travel then, whatever the backlash.
  const std::int64_t at_end = ExactStage(dimensions).place_of(state.driven);
  const std::int64_t far_end = (rightwards ? 1 : -1) * dimensions.travel / 2 * microsteps_per_turn;
  RC_ASSERT(std::abs(at_end - far_end) < dimensions.pitch);

  // The first edge that is met presses a switch, and the other one, or the hysteresis behind it, lets it go.
  const std::int64_t end = dimensions.travel / 2;
  const std::int64_t near = end - dimensions.limit_switch_distance;
  const std::int64_t far = near + dimensions.limit_switch_width;
  const std::int64_t home = dimensions.home_switch_center;
  const std::int64_t half = dimensions.home_switch_width / 2;
  const std::int64_t edges[machine_switch_count][2] = {{-far, -near}, {near, far}, {home - half, home + half}};
  const std::int64_t sign = rightwards ? 1 : -1;
  for (const MachineSwitch name : all_switches) {
    const auto i = static_cast<std::size_t>(name);
    const std::int64_t pressed = edges[i][rightwards ? 0 : 1];
    const std::int64_t released = edges[i][rightwards ? 1 : 0] + sign * dimensions.switch_hysteresis;
    RC_ASSERT(changes[i].size() == 2u);
    // Within the microstep that follows the edge, and the one that hysteresis is rounded to.
    const std::int64_t microstep = dimensions.pitch;
    const std::int64_t beyond = (changes[i][0] - pressed * microsteps_per_turn) * sign;
    RC_ASSERT(beyond >= 0 && beyond < microstep);
    RC_ASSERT(std::abs(changes[i][1] - released * microsteps_per_turn) <= 2 * microstep);
  }
}

RC_GTEST_PROP(Machine, DoesNotChatterWhileItSwingsWithinTheHysteresis, ()) {
  LinearStageDimensions dimensions = *any_stage();
  dimensions.backlash = 0;
  dimensions.mirrored = false;
  dimensions.switch_hysteresis = *rc::gen::inRange(0, 400);
  Walk stage(dimensions);
  const PlaceScale scale(dimensions.pitch, 1, dimensions.start);
  const std::int64_t edge = scale.first_angle_at(dimensions.home_switch_center - dimensions.home_switch_width / 2);
  const std::int64_t play = scale.angle_of(dimensions.switch_hysteresis);
  stage.to(edge - play - 1);
  const auto& home = stage.machine.state().switches[static_cast<std::size_t>(MachineSwitch::home)].contact;
  const std::uint32_t changes = home.changes;
  for (const auto swing : *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, play + 1))) {
    stage.to(edge - 1 - swing);
    RC_ASSERT(home.changes == changes);
  }
  stage.to(edge);
  RC_ASSERT(home.changes == changes + 1);
  for (const auto swing : *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, play + 1))) {
    stage.to(edge - swing);
    RC_ASSERT(home.changes == changes + 1);
  }
}

RC_GTEST_PROP(Machine, IsTheSameAfterALeapAsAfterMicrosteps, ()) {
  const MachineDimensions dimensions = *any_machine();
  Machine in_leaps(dimensions);
  Machine in_microsteps(dimensions);
  const AngleRange travel = in_leaps.travel();
  std::int64_t angle = 0;
  Tick tick = 0;
  for (const auto wanted :
       *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(-3000, 3000))) {
    // Begin near something, and leap no further than to the next change, as follow() demands.
    const EventDistance distance = in_leaps.next_event_distance(angle);
    const std::int64_t leap = std::clamp(wanted, distance.down == EventDistance::never ? -3000 : -distance.down,
                                         distance.up == EventDistance::never ? 3000 : distance.up);
    const std::int64_t target = std::clamp(angle + leap, travel.lowest, travel.highest);
    tick += 1000;
    in_leaps.follow(target, tick);
    while (angle != target) in_microsteps.follow(angle += target > angle ? 1 : -1, tick);
    in_microsteps.follow(angle, tick);
    RC_ASSERT(in_leaps.state() == in_microsteps.state());
  }
}

RC_GTEST_PROP(Machine, NeverTurnsItsPlaceBackAndLosesExactlyTheBacklashAtATurn, ()) {
  const MachineDimensions dimensions = *any_machine();
  Walk walk(dimensions);
  const bool mirrored = std::visit(
      [](const auto& kind) {
        if constexpr (requires { kind.mirrored; }) return kind.mirrored;
        return false;
      },
      dimensions);
  const std::int64_t direction = mirrored ? -1 : 1;
  const std::int64_t play = [&] {
    // The way up that the driven side does not follow, from where the shaft just turned down.
    walk.to(-direction * 1000);
    const std::int64_t stood = walk.machine.load_side_angle();
    walk.to(direction * 200'000);
    return direction * 200'000 - walk.machine.load_side_angle() + (stood + direction * 1000);
  }();
  const auto* stage = std::get_if<LinearStageDimensions>(&dimensions);
  const auto* axis = std::get_if<CircularAxisDimensions>(&dimensions);
  const std::int64_t expected = stage != nullptr ? stage->backlash * microsteps_per_turn / stage->pitch
                                                 : std::int64_t{axis->backlash} * axis->gear_numerator *
                                                       microsteps_per_turn / (360'000 * axis->gear_denominator);
  RC_ASSERT(std::abs(play) == expected);

  std::int64_t angle = direction * 200'000;
  std::int64_t driven = walk.machine.load_side_angle();
  for (const auto turn : *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(-2000, 2000))) {
    const std::int64_t place = walk.machine.place();
    walk.to(angle += turn);
    const std::int64_t way = walk.machine.load_side_angle() - driven;
    driven += way;
    RC_ASSERT(way * turn >= 0);
    RC_ASSERT(std::abs(way) <= std::abs(turn));
    RC_ASSERT((walk.machine.place() - place) * turn * direction >= 0);
    RC_ASSERT((angle - driven) * direction >= 0 && (angle - driven) * direction <= expected);
    RC_ASSERT(walk.machine.place_at(angle) == walk.machine.place());
  }
}

RC_GTEST_PROP(Machine, GoesOnFromASavedStateAsIfNothingHadBeen, ()) {
  const MachineDimensions dimensions = *any_machine();
  Walk walk(dimensions);
  const auto targets =
      *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(-400'000, 400'000));
  for (const std::int64_t target : targets) walk.to(target);
  Walk restored(dimensions);
  restored.machine.restore(walk.machine.state());
  restored.tick = walk.tick;
  for (const std::int64_t target : targets) {
    walk.to(target / 2);
    restored.to(target / 2);
    RC_ASSERT(restored.machine.state() == walk.machine.state());
    RC_ASSERT(restored.machine.next_event_distance(target / 2) == walk.machine.next_event_distance(target / 2));
  }
}

RC_GTEST_PROP(CircularAxis, HoldsItsMarkExactlyWhileTheTableIsWithinItsWidth, ()) {
  CircularAxisDimensions dimensions = *any_axis();
  dimensions.switch_hysteresis = 0;
  dimensions.backlash = 0;
  Walk axis(dimensions);
  const auto angle = *rc::gen::inRange<std::int64_t>(-100 * microsteps_per_turn, 100 * microsteps_per_turn);
  axis.to(angle);
  // 1/1000 degree, in units of 1/unit.
  const std::int64_t unit = microsteps_per_turn * dimensions.gear_numerator;
  const std::int64_t place =
      dimensions.start * unit + (dimensions.mirrored ? -angle : angle) * 360'000 * dimensions.gear_denominator;
  const std::int64_t within = floor_remainder(place - dimensions.home_mark_center * unit, 360'000 * unit);
  const std::int64_t half = dimensions.home_mark_width / 2 * unit;
  RC_ASSERT(axis.open().home == (within <= half || within >= 360'000 * unit - half));
  RC_ASSERT(axis.machine.place() == floor_quotient(place, unit));
}

TEST(Shaft, StandsInTheMicrostepWhoseBordersADoubleHas) {
  EXPECT_EQ(microstep_at(0.0), 0);
  EXPECT_EQ(microstep_at(-1e-12), -1);
  EXPECT_EQ(microstep_at(2.5), 2560);
  for (const std::int64_t microstep : {-1'254'400, -1, 0, 1, 77'777, 1 << 30}) {
    EXPECT_EQ(microstep_at(electrical_turns_at(microstep)), microstep);
    EXPECT_EQ(microstep_at(electrical_turns_at(microstep) - 1e-9), microstep - 1);
  }
}

}  // namespace
}  // namespace opentmcl::twin
