// Speeds, ramps and positions of the whole module against the closed formulas of chapter 6.1.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "firmware/chip/tmc429_registers.hpp"
#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr double second = 1e6;  // µs

/// Microsteps per second of an internal velocity (PD-1161 manual 6.1.1, equation 1).
double pulses_per_second(double velocity, int pulse_divisor) {
  return 16e6 * velocity / (std::ldexp(1.0, pulse_divisor) * 2048.0 * 32.0);
}

/// Microsteps per second² of an internal acceleration (equation 3).
double pulses_per_second_squared(double acceleration, int ramp_divisor, int pulse_divisor) {
  return 16e6 * 16e6 * acceleration / std::ldexp(1.0, ramp_divisor + pulse_divisor + 29);
}

TEST(Formulas, GiveTheWorkedExamplesOfTheManual) {
  EXPECT_NEAR(pulses_per_second(1678, 3), 51208.5, 0.05);
  EXPECT_NEAR(pulses_per_second_squared(100, 7, 3), 46566, 0.5);
}

TEST(VelocityMode, RunsAtTheSpeedOfTheFormulaForEveryPulseDivisor) {
  for (int pulse_divisor = 0; pulse_divisor <= 13; ++pulse_divisor) {
    Bench bench(pd1161);
    bench.set(AxisParameter::pulse_divisor, pulse_divisor);
    bench.set(AxisParameter::ramp_divisor, 0);
    bench.set(AxisParameter::maximum_acceleration, 2047);
    bench.command(Opcode::ror, 0, 0, 1678);
    bench.wait(one_millisecond * 100);
    ASSERT_EQ(bench.get(AxisParameter::actual_speed), 1678);
    const std::int64_t begin = bench.module.world().rotor_angle();
    const Microseconds time = 2'000 * one_millisecond;
    bench.wait(time);
    const auto steps = static_cast<double>(bench.module.world().rotor_angle() - begin);
    EXPECT_NEAR(steps, pulses_per_second(1678, pulse_divisor) * static_cast<double>(time) / second, 1.0)
        << "pulse divisor " << pulse_divisor;
  }
}

TEST(VelocityMode, AcceleratesByTheFormulaWithinOneRampTick) {
  for (const auto& [acceleration, ramp, pulse] : {std::tuple{100, 7, 3}, {1000, 7, 3}, {50, 9, 5}, {2047, 6, 2}}) {
    Bench bench(tmcm1110);
    bench.set(AxisParameter::ramp_divisor, ramp);
    bench.set(AxisParameter::pulse_divisor, pulse);
    bench.set(AxisParameter::maximum_acceleration, acceleration);
    bench.command(Opcode::ror, 0, 0, 2000);
    const Microseconds begin = bench.module.now();
    const auto velocity = [&bench] {
      const std::uint32_t reply = bench.module.world().transfer_tmc429(tmc429::read_datagram<tmc429::ActualVelocity>());
      return tmc429::ActualVelocity::Value::in(tmc429::word_in<tmc429::ActualVelocity>(reply));
    };
    while (velocity() < 2000) bench.module.advance_to(bench.module.now() + 10);
    const double expected =
        pulses_per_second(2000, pulse) / pulses_per_second_squared(acceleration, ramp, pulse) * second;
    const double ramp_tick = 32.0 * std::ldexp(1.0, ramp) / 16.0;  // µs
    // The command itself was carried out up to a turn of 3 ms before `begin`.
    EXPECT_NEAR(static_cast<double>(bench.module.now() - begin) + 3000, expected, ramp_tick + 3000) << acceleration;
  }
}

TEST(Left, IsTheNegativeOfRight) {
  Bench bench(pd1161);
  bench.command(Opcode::rol, 0, 0, 500);
  bench.wait(one_millisecond * 1000);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), -500);
  EXPECT_LT(bench.module.world().rotor_angle(), 0);
  bench.command(Opcode::rol, 0, 0, -300);
  bench.wait(one_millisecond * 1000);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 300);
  bench.command(Opcode::mst);
  bench.wait(one_millisecond * 1000);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0);
}

TEST(VelocityMode, IsNotLimitedByTheMaximumPositioningSpeed) {
  Bench bench(pd1161);
  bench.set(AxisParameter::maximum_positioning_speed, 100);
  bench.command(Opcode::ror, 0, 0, 1500);
  bench.wait(one_millisecond * 2000);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 1500);
  bench.command(Opcode::mvp, 1, 0, 1'000'000);
  bench.wait(one_millisecond * 2000);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 100) << "but a move is, right after";
}

TEST(PositionMode, LandsExactlyAndNeverPassesTheTarget) {
  EXPECT_TRUE(rc::check("random moves", [] {
    Bench bench(pd1161);
    const auto pulse = *rc::gen::inRange(0, 4);
    const auto ramp = *rc::gen::inRange(pulse, pulse + 3);
    // Within the limits of 6.1.3, and not so steep that one ramp tick changes the speed by more than a unit.
    bench.set(AxisParameter::pulse_divisor, pulse);
    bench.set(AxisParameter::ramp_divisor, ramp);
    bench.set(AxisParameter::maximum_acceleration, *rc::gen::inRange(8, 256));
    bench.set(AxisParameter::maximum_positioning_speed, *rc::gen::inRange(50, 2048));
    std::int32_t position = 0;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t target = *rc::gen::inRange(-60'000, 60'000);
      const bool up = target > position;
      bench.command(Opcode::mvp, 0, 0, target);
      const Microseconds begin = bench.module.now();
      while (bench.get(AxisParameter::position_reached) == 0) {
        RC_ASSERT(bench.module.now() - begin < 60'000 * one_millisecond);
        const std::int32_t now = bench.get(AxisParameter::actual_position);
        const bool is_short_of_it = up ? now <= target : now >= target;
        RC_ASSERT(is_short_of_it);
      }
      bench.wait(one_millisecond * 50);
      RC_ASSERT(bench.get(AxisParameter::actual_position) == target);
      RC_ASSERT(bench.get(AxisParameter::actual_speed) == 0);
      RC_ASSERT(bench.module.world().rotor_angle() == target);
      position = target;
    }
  }));
}

TEST(PositionMode, MakesOneRampOfAMoveOfAHundredMillionMicrosteps) {
  VirtualModule::Options free_shaft;
  free_shaft.machine = twin::RotaryAxisDimensions{};
  Bench bench(pd1161, hal::PortKind::usb, nullptr, free_shaft);
  bench.set(AxisParameter::pulse_divisor, 0);
  bench.set(AxisParameter::ramp_divisor, 4);
  bench.set(AxisParameter::maximum_acceleration, 100);
  bench.set(AxisParameter::maximum_positioning_speed, 2047);
  constexpr std::int32_t distance = 100'000'000;
  bench.command(Opcode::mvp, 0, 0, distance);
  const double top = pulses_per_second(2047, 0);
  const double ramp_time = top / pulses_per_second_squared(100, 4, 0);
  const double expected = distance / top + ramp_time;  // trapezoid
  bench.wait(static_cast<Microseconds>((ramp_time + 0.1) * second));
  // The whole way in between at full speed: nothing brakes for the points the chip's 24 bits are led along.
  while (bench.get(AxisParameter::actual_position) < distance - static_cast<std::int32_t>(top * ramp_time)) {
    ASSERT_EQ(bench.get(AxisParameter::actual_speed), 2047);
    bench.wait(one_millisecond * 47);
  }
  bench.wait_until_reached(20'000 * one_millisecond);
  EXPECT_EQ(bench.module.world().rotor_angle(), distance);
  EXPECT_NEAR(static_cast<double>(bench.module.now()) / second, expected, 0.06 * ramp_time + 0.05);
}

TEST(PositionMode, GoesTheShortWayRoundWhenTheDistanceWrapsAt32Bits) {
  Bench bench(pd1161);
  bench.set(AxisParameter::ramp_divisor, 3);
  bench.command(Opcode::mst);
  bench.set(AxisParameter::actual_position, int32_maximum - 1000);
  bench.command(Opcode::mvp, 0, 0, int32_minimum + 1000);
  bench.wait_until_reached(10'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), int32_minimum + 1000);
  EXPECT_EQ(bench.module.world().rotor_angle(), 2001);
}

TEST(PositionMode, ReachesBothEndsOfThe32BitRange) {
  for (const std::int32_t end : {int32_minimum, int32_maximum}) {
    Bench bench(pd1161);
    bench.command(Opcode::mst);
    bench.set(AxisParameter::actual_position, end > 0 ? end - 40'000 : end + 40'000);
    bench.command(Opcode::mvp, 0, 0, end);
    bench.wait_until_reached(10'000 * one_millisecond);
    EXPECT_EQ(bench.get(AxisParameter::actual_position), end);
  }
}

TEST(RelativeMove, AnswersWithTheNewTarget) {
  Bench bench(pd1161);
  bench.command(Opcode::mst);
  bench.set(AxisParameter::actual_position, 500);
  const Reply reply = bench.command(Opcode::mvp, 1, 0, -700);
  EXPECT_EQ(reply.value, -200);
  bench.wait_until_reached(5'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), -200);
}

TEST(MoveToACoordinate, GoesWhereItWasSetOrCaptured) {
  Bench bench(pd1161);
  bench.command(Opcode::sco, 5, 0, 3000);
  bench.command(Opcode::mvp, 2, 0, 5);
  bench.wait_until_reached(5'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 3000);
  EXPECT_EQ(bench.command(Opcode::cco, 6).value, 3000);
  EXPECT_EQ(bench.command(Opcode::gco, 6).value, 3000);
  EXPECT_EQ(bench.command(Opcode::mvp, 2, 0, 21).status, Status::invalid_value);
  EXPECT_EQ(bench.command(Opcode::mvp, 3, 0, 0).status, Status::wrong_type);
  EXPECT_EQ(bench.command(Opcode::sco, 21, 0, 0).status, Status::wrong_type);
}

TEST(SecondReply, ComesWhenTheTargetOfAMoveIsReached) {
  Bench bench(pd1161);
  for (const bool every : {false, true}) {
    EXPECT_EQ(bench.command(Opcode::request_position_reached, every ? 1 : 0, 0, 1).status, Status::ok);
    for (int move = 1; move <= 2; ++move) {
      bench.command(Opcode::mvp, 1, 0, 2000);
      bench.port.received.clear();
      bench.wait(2'000 * one_millisecond);
      const std::vector<std::uint8_t> expected{2, 1, 128, 138, 0, 0, 0, 1, 14};
      const bool reports = every || move == 1;
      EXPECT_EQ(bench.port.received, reports ? expected : std::vector<std::uint8_t>{});
    }
  }
}

TEST(ActualPosition, WrittenInPositionModeMakesTheMotorDriveBackToItsTarget) {
  Bench bench(pd1161);
  bench.command(Opcode::mvp, 0, 0, 1000);
  bench.wait_until_reached(5'000 * one_millisecond);
  bench.set(AxisParameter::actual_position, 0);
  bench.wait_until_reached(5'000 * one_millisecond);
  EXPECT_EQ(bench.module.world().rotor_angle(), 2000);
}

TEST(LimitSwitches, StopOnlyTheDirectionTheyAreFor) {
  Bench bench(pd1161);
  bench.set(AxisParameter::left_limit_switch_disable, 0);
  bench.set(AxisParameter::right_limit_switch_disable, 0);
  bench.module.world().set_right_switch(true);
  EXPECT_EQ(bench.get(AxisParameter::right_limit_switch_state), 1);
  EXPECT_EQ(bench.get(AxisParameter::left_limit_switch_state), 0);
  bench.command(Opcode::ror, 0, 0, 500);
  bench.wait(500 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 0);
  bench.command(Opcode::rol, 0, 0, 500);
  bench.wait(1'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), -500);
}

TEST(LimitSwitches, AreActiveLowWithTheOtherPolarity) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::end_switch_polarity, 1);
  EXPECT_EQ(bench.get(AxisParameter::left_limit_switch_state), 1);
  bench.module.world().set_left_switch(true);
  EXPECT_EQ(bench.get(AxisParameter::left_limit_switch_state), 0);
}

TEST(ReverseShaft, TurnsTheMotorTheOtherWayAndCountsAsBefore) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::reverse_shaft, 1);
  bench.command(Opcode::mvp, 0, 0, 5000);
  bench.wait_until_reached(5'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 5000);
  EXPECT_EQ(bench.module.world().rotor_angle(), -5000);
}

TEST(MicrostepResolution, DecidesHowFarAMicrostepTurnsTheShaft) {
  for (int resolution = 0; resolution <= 8; ++resolution) {
    Bench bench(pd1161);
    bench.set(AxisParameter::microstep_resolution, resolution);
    bench.set(AxisParameter::ramp_divisor, 3);
    bench.command(Opcode::mvp, 0, 0, 64);
    bench.wait_until_reached(10'000 * one_millisecond);
    EXPECT_EQ(bench.module.world().rotor_angle(), 64 << (8 - resolution)) << "2^" << resolution;
  }
}

TEST(StandbyCurrent, IsUsedAfterThePowerDownDelayAtRest) {
  Bench bench(pd1161);
  bench.set(AxisParameter::maximum_current, 160);
  bench.set(AxisParameter::standby_current, 40);
  bench.set(AxisParameter::power_down_delay, 50);
  bench.command(Opcode::ror, 0, 0, 400);
  bench.wait(1'000 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::smart_energy_actual_current), 20);
  bench.command(Opcode::mst);
  while (bench.get(AxisParameter::actual_speed) != 0) bench.wait(one_millisecond);
  bench.wait(450 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::smart_energy_actual_current), 20) << "still within the delay";
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::smart_energy_actual_current), 5);
  bench.command(Opcode::mvp, 1, 0, 1000);
  bench.wait(5 * one_millisecond);
  EXPECT_EQ(bench.get(AxisParameter::smart_energy_actual_current), 20) << "run current at once";
}

TEST(VirtualModule, GivesTheSameTraceForTheSameCommandsAtTheSameTimes) {
  const auto trace = [](Microseconds slice) {
    twin::TraceText text;
    TestPort port;
    VirtualModule module(pd1161, {{&port, hal::PortKind::usb}}, {}, &text);
    const auto at = [&](Microseconds time, Opcode opcode, std::int32_t value) {
      while (module.now() < time) module.advance_to(std::min(time, module.now() + slice));
      const Datagram request = encode(Request{1, {static_cast<std::uint8_t>(opcode), 0, 0, value}});
      port.to_module.insert(port.to_module.end(), request.bytes, request.bytes + datagram_size);
      module.wake();
    };
    at(1'000, Opcode::ror, 700);
    at(150'000, Opcode::mvp, -3000);
    at(400'123, Opcode::mst, 0);
    at(600'000, Opcode::mvp, 100);
    at(900'000, Opcode::mst, 0);
    return text.text();
  };
  const std::string reference = trace(1'000'000);
  EXPECT_GT(reference.size(), 100'000U);
  EXPECT_TRUE(trace(10) == reference);
  EXPECT_TRUE(trace(777) == reference);
}

}  // namespace
}  // namespace opentmcl::tests
