// The reference search on the linear stage that the virtual modules have.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <vector>

#include "firmware/chip/tmc429_registers.hpp"
#include "tests/module/bench.hpp"
#include "twin/physics/shaft.hpp"

namespace opentmcl::tests {
namespace {

using Dimensions = twin::LinearStageDimensions;

constexpr std::int32_t resolution = 4;             // 16 microsteps: fast to simulate
constexpr std::int64_t shaft_angle_per_step = 16;  // 1/256 full steps

/// Shaft angle of a distance on the default stage of 2 mm a turn. @param distance µm
constexpr std::int64_t angle_of(std::int64_t distance) {
  return distance * twin::microsteps_per_turn / 2000;
}

/// Places on the default stage, µm from the middle.
constexpr std::int32_t left_edge = -48'000;
constexpr std::int32_t left_middle = -48'500;
constexpr std::int32_t home_middle = -10'000;

bool is_near(std::int64_t value, std::int64_t expected, std::int64_t tolerance) {
  return std::abs(value - expected) <= tolerance;
}

/// A module whose slider stands at `start` µm, with a steep ramp.
struct Homing : Bench {
  explicit Homing(const ModuleDescription& description, const Dimensions& dimensions = {})
      : Bench(description, hal::PortKind::usb, nullptr, {.machine = dimensions}), start(dimensions.start) {
    set(AxisParameter::microstep_resolution, resolution);
    set(AxisParameter::pulse_divisor, 2);
    set(AxisParameter::ramp_divisor, 4);
    set(AxisParameter::reference_search_speed, 1500);
    set(AxisParameter::reference_switch_speed, 100);
  }
  Homing(const ModuleDescription& description, std::int32_t from) : Homing(description, starting_at(from)) {}

  static Dimensions starting_at(std::int32_t place) {
    Dimensions dimensions;
    dimensions.start = place;
    return dimensions;
  }

  /// So gentle a ramp that no state is over between two questions of the host.
  void slow_down() {
    set(AxisParameter::maximum_acceleration, 20);
    set(AxisParameter::reference_search_speed, 200);
  }

  void start_search(int mode) {
    set(AxisParameter::reference_search_mode, mode);
    EXPECT_EQ(command(Opcode::rfs, 0).status, Status::ok);
  }
  std::int32_t search_status() { return command(Opcode::rfs, 2).value; }

  /// Waits for the end of the search. @return the states it went through
  std::vector<std::int32_t> finish() {
    std::vector<std::int32_t> states{search_status()};
    const Microseconds limit = module.now() + 60'000 * one_millisecond;
    while (states.back() != 0 && states.back() != 15) {
      if (module.now() > limit) {
        ADD_FAILURE() << "does not end: state " << states.back();
        break;
      }
      wait(one_millisecond);
      if (const std::int32_t now = search_status(); now != states.back()) states.push_back(now);
    }
    return states;
  }

  /// Where the slider stands, as the shaft angle that leads there from the middle.
  std::int64_t place() const { return angle_of(start) + module.world().rotor_angle(); }

  /// How far the axis moves in 1 ms at a speed, as a shaft angle, rounded up.
  static std::int64_t millisecond_of(std::int32_t velocity) {
    // 16·10⁶ × v / (2^2 × 2048 × 32) steps a second (PD-1161 manual 6.1.1)
    return (velocity * 61 / 1000 + 1) * shaft_angle_per_step;
  }

  std::int32_t start;
};

/// µm from the middle where the origin is, without options.
std::int32_t origin_of(int mode) {
  if (mode <= 2) return left_edge;
  return mode <= 4 ? left_middle : home_middle;
}

/// Modes 7 and 8 do not turn back: the home switch has to lie ahead.
bool can_succeed(int mode, std::int32_t from) {
  if (mode == 7) return from >= home_middle;
  return mode != 8 || from <= home_middle;
}

TEST(ReferenceSearch, FindsTheOriginOfEveryModeOnBothModulesFromEverywhere) {
  for (const ModuleDescription* description : {&pd1161, &tmcm1110}) {
    for (const int mode : {1, 2, 3, 4, 5, 6, 7, 8, 65, 66, 67, 68}) {
      if (mode > 64 && description != &pd1161) continue;
      // On a limit switch, on the home switch, and in between.
      for (const std::int32_t from : {-48'500, -30'000, -10'000, 15'000, 48'005}) {
        if (!can_succeed(mode, from)) continue;
        SCOPED_TRACE(testing::Message() << description->name << ", mode " << mode << " from " << from << " um");
        Homing bench(*description, from);
        bench.start_search(mode);
        EXPECT_NE(bench.search_status(), 0);
        bench.finish();
        const int side = mode > 64 ? -1 : 1;
        const std::int64_t origin = side * angle_of(origin_of(mode & 63));
        const std::int64_t tolerance = Homing::millisecond_of(100);
        EXPECT_PRED3(is_near, bench.place(), origin, tolerance);
        EXPECT_EQ(bench.get(AxisParameter::actual_position), 0);
        EXPECT_EQ(bench.get(AxisParameter::last_reference_position),
                  bench.module.world().rotor_angle() / shaft_angle_per_step);
        const bool measures_distance = (mode & 63) == 2 || (mode & 63) == 3;
        const std::int64_t distance = measures_distance ? angle_of((mode & 63) == 2 ? 96'000 : 96'500) : 0;
        EXPECT_PRED3(is_near, bench.get(AxisParameter::end_switch_distance) * shaft_angle_per_step, distance,
                     Homing::millisecond_of(measures_distance ? 1500 : 0) + tolerance);
      }
    }
  }
}

TEST(ReferenceSearch, FindsTheSamePlaceFromAnyStartAtAnySpeedEvenWhenItOvershoots) {
  EXPECT_TRUE(rc::check("random searches", [] {
    const bool right = *rc::gen::arbitrary<bool>();
    const int mode = *rc::gen::inRange(1, 9);
    const std::int32_t from = 5 * *rc::gen::inRange(-48'900 / 5, 48'900 / 5);  // on a whole microstep
    RC_PRE(can_succeed(mode, from));
    const auto fast = *rc::gen::inRange(400, 2048);
    const auto slow = *rc::gen::inRange(20, 400);
    const bool uses_right = right && mode <= 4;
    Homing bench(uses_right ? pd1161 : **rc::gen::element(&pd1161, &tmcm1110), from);
    // At top speed the motor needs 6 mm to stop: through a switch of 1 mm, and into the end 2 mm behind it.
    bench.set(AxisParameter::maximum_acceleration, *rc::gen::element(100, 200, 2047));
    bench.set(AxisParameter::reference_search_speed, fast);
    bench.set(AxisParameter::reference_switch_speed, slow);
    bench.start_search(mode + (uses_right ? 64 : 0));
    RC_ASSERT(bench.finish().back() == 0);
    const std::int64_t error = bench.place() - (uses_right ? -1 : 1) * angle_of(origin_of(mode));
    RC_ASSERT(std::abs(error) <= Homing::millisecond_of(slow));
    RC_ASSERT(bench.get(AxisParameter::actual_position) == 0);
  }));
}

TEST(ReferenceSearch, ShowsItsStateInTheStatus) {
  using States = std::vector<std::int32_t>;
  struct Row {
    int mode;
    std::int32_t from;
    States states;
  };
  const Row rows[] = {
      {1, 0, {2, 4, 5, 6, 8, 9, 0}},    {2, 0, {1, 2, 4, 5, 6, 8, 9, 0}},       {4, 0, {2, 4, 5, 6, 7, 8, 9, 0}},
      {5, 0, {2, 4, 5, 6, 7, 8, 9, 0}}, {5, -20'000, {2, 3, 5, 6, 7, 8, 9, 0}}, {6, -48'500, {2, 4, 5, 6, 7, 8, 9, 0}},
  };
  for (const Row& row : rows) {
    Homing bench(pd1161, row.from);
    bench.slow_down();
    bench.start_search(row.mode);
    EXPECT_EQ(bench.finish(), row.states) << "mode " << row.mode << " from " << row.from;
  }
}

TEST(ReferenceSearch, ComesBackToASwitchThatItPassed) {
  Homing bench(pd1161, 20'000);
  bench.set(AxisParameter::maximum_acceleration, 200);
  bench.start_search(7);
  EXPECT_EQ(bench.finish(), (std::vector<std::int32_t>{2, 4, 3, 5, 6, 7, 8, 9, 0}));
  EXPECT_PRED3(is_near, bench.place(), angle_of(home_middle), Homing::millisecond_of(100));
}

TEST(ReferenceSearch, IgnoresASwitchThatItPassesWhileItStillTurnsRound) {
  Homing bench(pd1161, -12'000);
  bench.set(AxisParameter::maximum_acceleration, 20);
  bench.command(Opcode::ror, 0, 0, 1500);
  while (bench.get(AxisParameter::home_switch_state) == 0) bench.wait(one_millisecond);
  bench.start_search(5);
  bench.finish();
  EXPECT_PRED3(is_near, bench.place(), angle_of(home_middle), Homing::millisecond_of(100));
}

TEST(ReferenceSearch, TakesNormallyOpenSwitchesWithTheOtherPolarities) {
  Dimensions dimensions;
  dimensions.contact = Dimensions::Contact::normally_open;
  for (const auto& [mode, place] : {std::pair{1, left_edge}, {128 + 5, home_middle}, {128 + 6, home_middle}}) {
    Homing bench(pd1161, dimensions);
    bench.set(GlobalParameter::end_switch_polarity, 1);
    bench.start_search(mode);
    bench.finish();
    EXPECT_PRED3(is_near, bench.place(), angle_of(place), Homing::millisecond_of(100)) << "mode " << mode;
  }
}

TEST(ReferenceSearch, MeasuresContactsThatBounceWhenTheyHaveComeToRest) {
  Dimensions dimensions;
  dimensions.switch_bounce = 6'000;  // µs
  for (const auto& [mode, place] : {std::pair{1, left_edge}, {4, left_middle}, {5, home_middle}, {6, home_middle}}) {
    Homing bench(pd1161, dimensions);
    bench.start_search(mode);
    bench.finish();
    EXPECT_PRED3(is_near, bench.place(), angle_of(place), 7 * Homing::millisecond_of(100)) << "mode " << mode;
  }
}

TEST(ReferenceSearch, WaitsForAContactThatBouncesBehindTheMotorBeforeItTurnsBack) {
  Dimensions dimensions;
  dimensions.switch_bounce = 9'000;
  dimensions.home_switch_width = 300;
  for (std::int32_t fast = 1'000; fast < 1'100; fast += 10) {  // it comes to stand at other places each time
    Homing bench(pd1161, dimensions);
    bench.set(AxisParameter::maximum_acceleration, 2047);
    bench.set(AxisParameter::reference_search_speed, fast);
    bench.start_search(7);
    EXPECT_EQ(bench.finish().back(), 0);
    EXPECT_PRED3(is_near, bench.place(), angle_of(home_middle), 10 * Homing::millisecond_of(100));
  }
}

TEST(ReferenceSearch, FindsTheLeftSwitchWithTheMotorAtTheOtherEndAndTheShaftReversed) {
  Dimensions dimensions;
  dimensions.mirrored = true;
  Homing bench(pd1161, dimensions);
  bench.set(GlobalParameter::reverse_shaft, 1);
  bench.start_search(2);
  bench.finish();
  EXPECT_PRED3(is_near, -bench.place(), angle_of(left_edge), Homing::millisecond_of(100));
}

TEST(ReferenceSearch, IsNotStoppedByTheLimitSwitchesThatStopTheMotorBeforeAndAfter) {
  Homing bench(pd1161, 0);
  bench.set(AxisParameter::left_limit_switch_disable, 0);
  bench.set(AxisParameter::right_limit_switch_disable, 0);
  bench.start_search(3);
  bench.finish();
  EXPECT_PRED3(is_near, bench.place(), angle_of(left_middle), Homing::millisecond_of(100));
  bench.command(Opcode::rol, 0, 0, 100);
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0) << "stands on the switch";
  bench.command(Opcode::ror, 0, 0, 1000);
  bench.wait(20'000 * one_millisecond);
  EXPECT_PRED3(is_near, bench.place(), angle_of(48'000), shaft_angle_per_step);
}

struct Abortion {
  const char* name;
  std::function<void(Bench&)> act;
  std::int32_t speed;  ///< in the end
};

const Abortion abortions[] = {
    {"RFS STOP", [](Bench& bench) { bench.command(Opcode::rfs, 1); }, 0},
    {"MST", [](Bench& bench) { bench.command(Opcode::mst); }, 0},
    {"ROR", [](Bench& bench) { bench.command(Opcode::ror, 0, 0, 7); }, 7},
    {"ROL", [](Bench& bench) { bench.command(Opcode::rol, 0, 0, 7); }, -7},
    {"MVP", [](Bench& bench) { bench.command(Opcode::mvp, 1, 0, 100); }, 0},
};

TEST(ReferenceSearch, IsAbortedInEveryStateAndLeavesAllSettingsAsTheyWere) {
  constexpr AxisParameter settings[] = {
      AxisParameter::maximum_positioning_speed, AxisParameter::maximum_acceleration,
      AxisParameter::left_limit_switch_disable, AxisParameter::right_limit_switch_disable,
      AxisParameter::reference_search_mode,     AxisParameter::reference_search_speed,
      AxisParameter::reference_switch_speed,
  };
  std::vector<std::int32_t> states_aborted;
  for (const Abortion& abortion : abortions) {
    for (const auto& [mode, from] : {std::pair{3, 40'000}, {5, -13'000}}) {
      for (std::int32_t state = 1; state <= 9; ++state) {
        SCOPED_TRACE(testing::Message() << abortion.name << " in state " << state);
        Homing bench(tmcm1110, from);
        bench.slow_down();
        bench.set(AxisParameter::left_limit_switch_disable, 0);
        std::vector<std::int32_t> before;
        bench.set(AxisParameter::reference_search_mode, mode);
        for (const AxisParameter setting : settings) before.push_back(bench.get(setting));
        bench.start_search(mode);
        std::int32_t status = bench.search_status();
        for (; status != state && status != 0; status = bench.search_status()) bench.wait(one_millisecond);
        if (status == 0) continue;  // this mode does not have that state from there
        states_aborted.push_back(state);
        abortion.act(bench);
        EXPECT_EQ(bench.search_status(), 15);
        std::vector<std::int32_t> after;
        for (const AxisParameter setting : settings) after.push_back(bench.get(setting));
        EXPECT_EQ(after, before);
        const std::uint32_t reply = bench.module.world().transfer_tmc429(tmc429::read_datagram<tmc429::Mode>());
        const auto chip_mode = tmc429::word_in<tmc429::Mode>(reply);
        EXPECT_FALSE(tmc429::Mode::DisableLeftStop::is_set(chip_mode));
        EXPECT_TRUE(tmc429::Mode::DisableRightStop::is_set(chip_mode));
        bench.wait(300 * one_millisecond);
        const bool held = bench.get(AxisParameter::left_limit_switch_state) != 0 && abortion.speed < 0;
        EXPECT_EQ(bench.get(AxisParameter::actual_speed), held ? 0 : abortion.speed);
        EXPECT_EQ(bench.search_status(), 15);
      }
    }
  }
  for (std::int32_t state = 1; state <= 9; ++state) {
    EXPECT_NE(std::count(states_aborted.begin(), states_aborted.end(), state), 0) << "state " << state;
  }
}

TEST(ReferenceSearch, StartsAgainWhenItIsStartedWhileUnderWay) {
  Homing bench(pd1161, 0);
  bench.start_search(1);
  bench.wait(50 * one_millisecond);
  bench.start_search(6);
  bench.finish();
  EXPECT_PRED3(is_near, bench.place(), angle_of(home_middle), Homing::millisecond_of(100));
}

VirtualModule::Options free_shaft() {
  VirtualModule::Options options;
  options.machine = twin::RotaryAxisDimensions{};
  return options;
}

TEST(ReferenceSearch, GoesOnUntilItIsAbortedWhereThereIsNoSwitch) {
  for (const int mode : {1, 2, 3, 4, 5, 6, 7, 8}) {
    Bench bench(pd1161, hal::PortKind::usb, nullptr, free_shaft());
    bench.set(AxisParameter::reference_search_mode, mode);
    bench.command(Opcode::rfs, 0);
    bench.wait(20'000 * one_millisecond);
    const bool begins_at_other_end = mode == 2 || mode == 3;
    EXPECT_EQ(bench.command(Opcode::rfs, 2).value, begins_at_other_end ? 1 : 2);
    bench.command(Opcode::rfs, 1);
    bench.wait(1'000 * one_millisecond);
    EXPECT_EQ(bench.command(Opcode::rfs, 2).value, 15);
    EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0);
  }
}

TEST(ReferenceSearch, IsWaitedForByAProgram) {
  Homing bench(pd1161, 0);
  bench.run_program("RFS START, 0\nWAIT RFS, 0, 0\nRFS STATUS, 0\nJC NZ, Bad\nSGP 0, 2, 1\nBad: STOP\n");
  bench.wait(30'000 * one_millisecond);
  EXPECT_EQ(bench.command(Opcode::ggp, 0, 2).value, 1);
  EXPECT_PRED3(is_near, bench.place(), angle_of(left_edge), Homing::millisecond_of(100));
}

TEST(ReferenceSearch, IsGivenUpByAProgramThatWaitedLongEnough) {
  Bench bench(tmcm1110, hal::PortKind::usb, nullptr, free_shaft());
  bench.run_program("RFS START, 0\nWAIT RFS, 0, 50\nJC ETO, Late\nSTOP\nLate: RFS STOP, 0\nSGP 0, 2, 1\nSTOP\n");
  bench.wait(2'000 * one_millisecond);
  EXPECT_EQ(bench.command(Opcode::ggp, 0, 2).value, 1);
  EXPECT_EQ(bench.command(Opcode::rfs, 2).value, 15);
}

TEST(Wait, SeesTheSwitchesOfTheStage) {
  struct Row {
    const char* program;
    std::int32_t place;  // µm
  };
  const Row rows[] = {{"ROL 0, 1000\nWAIT REFSW, 0, 0\nMST 0\nSTOP\n", -9'500},
                      {"ROR 0, 1000\nWAIT LIMSW, 0, 0\nMST 0\nSTOP\n", 48'000}};
  for (const Row& row : rows) {
    Homing bench(pd1161, 0);
    bench.run_program(row.program);
    bench.wait(20'000 * one_millisecond);
    EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0);
    EXPECT_PRED3(is_near, bench.place(), angle_of(row.place), angle_of(500));
  }
}

}  // namespace
}  // namespace opentmcl::tests
