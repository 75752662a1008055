// What stops the motor without a command, and how host and program hear of it: parameters 181, 207 and 212, interrupts
// 15 and 21, the error flags of JC and CLE.
#include <gtest/gtest.h>

#include <optional>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr std::int32_t stall_flag = 1;
constexpr std::int32_t deviation_flag = 2;

class Supervision : public testing::TestWithParam<ModuleId> {
 protected:
  void wait_ms(unsigned milliseconds) { bench.wait(milliseconds * one_millisecond); }
  std::int32_t speed() { return bench.get(AxisParameter::actual_speed); }
  std::int32_t flags() { return bench.get(AxisParameter::extended_error_flags); }
  std::int32_t variable(std::uint8_t number) { return bench.command(Opcode::ggp, number, 2).value; }
  /// A stall while the motor turns at `speed`.
  void stall_at(std::int32_t speed) {
    bench.module.world().set_load_measurement(1023);
    bench.command(Opcode::ror, 0, 0, speed);
    wait_ms(500);
    bench.module.world().set_load_measurement(measured_at_a_stall);
    wait_ms(500);
  }
  /// Without current the shaft stays where it is, and position and encoder part.
  void lose_steps() { bench.set(AxisParameter::chopper_off_time, 0); }

  Bench bench{modules[static_cast<std::size_t>(GetParam())]};
};

INSTANTIATE_TEST_SUITE_P(Both, Supervision, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(Supervision, StopsTheMotorAtOnceAtAStallAboveTheStopOnStallSpeed) {
  bench.set(AxisParameter::stop_on_stall, 600);
  stall_at(700);
  EXPECT_EQ(speed(), 0);
  EXPECT_EQ(bench.get(AxisParameter::target_speed), 0);
  EXPECT_EQ(flags(), stall_flag);
  EXPECT_EQ(flags(), 0) << "cleared by reading";
}

TEST_P(Supervision, StopsWithoutARamp) {
  bench.set(AxisParameter::stop_on_stall, 600);
  bench.set(AxisParameter::maximum_acceleration, 10);
  bench.set(AxisParameter::stall_guard_filter, 0);
  bench.command(Opcode::ror, 0, 0, 2000);
  while (speed() < 1000) wait_ms(100);
  bench.module.world().set_load_measurement(measured_at_a_stall);
  wait_ms(20);
  EXPECT_EQ(speed(), 0) << "at this acceleration a ramp would take seconds";
}

TEST_P(Supervision, RunsOnAtAStallUpToThatSpeed) {
  bench.set(AxisParameter::stop_on_stall, 600);
  stall_at(600);
  EXPECT_EQ(speed(), 600);
  EXPECT_EQ(flags(), 0);
}

TEST_P(Supervision, NeverStopsAtAStallWithStopOnStallZero) {
  stall_at(1000);
  EXPECT_EQ(speed(), 1000);
}

TEST_P(Supervision, StartsAgainAfterAStallThoughTheDriverStillShowsIt) {
  bench.set(AxisParameter::stop_on_stall, 20);
  stall_at(700);
  EXPECT_EQ(speed(), 0);
  EXPECT_EQ(bench.get(AxisParameter::driver_error_flags) & 1, 1);
  bench.module.world().set_load_measurement(1023);
  bench.command(Opcode::ror, 0, 0, 700);
  wait_ms(500);
  EXPECT_EQ(speed(), 700);
}

TEST_P(Supervision, ClearsTheErrorFlagsWithEveryMotionCommand) {
  bench.set(AxisParameter::stop_on_stall, 100);
  for (const Opcode command : {Opcode::ror, Opcode::rol, Opcode::mst, Opcode::mvp}) {
    stall_at(700);
    bench.module.world().set_load_measurement(1023);
    bench.command(command);
    EXPECT_EQ(flags(), 0) << static_cast<int>(command);
    stall_at(700);
    EXPECT_EQ(flags(), stall_flag) << static_cast<int>(command);
  }
}

TEST_P(Supervision, EndsAReferenceSearchAtAStall) {
  bench.set(AxisParameter::stop_on_stall, 100);
  bench.command(Opcode::rfs, 0);
  wait_ms(500);
  bench.module.world().set_load_measurement(measured_at_a_stall);
  wait_ms(500);
  EXPECT_EQ(speed(), 0);
  EXPECT_EQ(bench.command(Opcode::rfs, 2).value, 15);
}

TEST_P(Supervision, StopsTheMotorWhenTheEncoderDoesNotFollow) {
  bench.set(AxisParameter::maximum_encoder_deviation, 2000);
  bench.command(Opcode::mvp, 0, 0, 100'000);
  wait_ms(500);
  EXPECT_GT(speed(), 0) << "as long as it follows nothing happens";
  const std::int32_t begin = bench.get(AxisParameter::actual_position);
  lose_steps();
  wait_ms(1'000);
  EXPECT_EQ(speed(), 0);
  // 2000 microsteps, the counts of the encoder, and at most a millisecond of the way at this speed.
  EXPECT_NEAR(bench.get(AxisParameter::actual_position) - begin, 2000, 150);
  EXPECT_EQ(bench.get(AxisParameter::position_reached), 0);
  EXPECT_EQ(flags(), deviation_flag);
  EXPECT_EQ(flags(), 0);
}

TEST_P(Supervision, StopsAtADeviationToEitherSide) {
  for (const Opcode direction : {Opcode::ror, Opcode::rol}) {
    Bench fresh(bench.module.description());
    fresh.set(AxisParameter::maximum_encoder_deviation, 500);
    fresh.set(AxisParameter::chopper_off_time, 0);
    fresh.command(direction, 0, 0, 300);
    fresh.wait(1'000 * one_millisecond);
    EXPECT_EQ(fresh.get(AxisParameter::actual_speed), 0);
    EXPECT_EQ(fresh.get(AxisParameter::extended_error_flags), deviation_flag);
  }
}

TEST_P(Supervision, LetsTheMotorGoOnWhenThePositionsAreMadeEqualAgain) {
  // With current again the rotor finds a place four full steps or a multiple of them away: 1024 microsteps.
  bench.set(AxisParameter::maximum_encoder_deviation, 5'000);
  lose_steps();
  bench.command(Opcode::ror, 0, 0, 300);
  wait_ms(1'000);
  bench.set(AxisParameter::chopper_off_time, 5);
  bench.command(Opcode::ror, 0, 0, 300);
  wait_ms(100);
  EXPECT_EQ(speed(), 0) << "they still differ";
  bench.set(AxisParameter::encoder_position, bench.get(AxisParameter::actual_position));
  bench.command(Opcode::ror, 0, 0, 300);
  wait_ms(500);
  EXPECT_EQ(speed(), 300);
}

TEST_P(Supervision, InterruptsTheProgramAtAStallAndAtADeviation) {
  bench.set(AxisParameter::stop_on_stall, 100);
  bench.set(AxisParameter::maximum_encoder_deviation, 2000);
  bench.run_program(R"(
         VECT 15, Stalled
         VECT 21, Deviates
         EI 15
         EI 21
         EI 255
   Loop: JA Loop
Stalled: SGP 1, 2, 15
         RETI
Deviates: SGP 2, 2, 21
         RETI
)");
  stall_at(500);
  EXPECT_EQ(variable(1), 15);
  EXPECT_EQ(variable(2), 0);
  bench.module.world().set_load_measurement(1023);
  bench.command(Opcode::ror, 0, 0, 500);
  wait_ms(500);
  lose_steps();
  wait_ms(500);
  EXPECT_EQ(variable(2), 21);
}

TEST_P(Supervision, LooksAtAMotorThatIsCommandedAllTheTime) {
  bench.set(AxisParameter::stop_on_stall, 100);
  bench.set(AxisParameter::smart_energy_threshold_speed, 200);
  bench.set(AxisParameter::smart_energy_slow_run_current, 255);
  bench.run_program(R"(
         VECT 15, Stalled
         EI 15
         EI 255
   Loop: ROR 0, 500
         JA Loop
Stalled: SGP 1, 2, 15
         MST 0
         STOP
)");
  wait_ms(500);
  EXPECT_EQ(bench.get(AxisParameter::smart_energy_actual_current), 16);
  bench.module.world().set_load_measurement(measured_at_a_stall);
  wait_ms(200);
  EXPECT_EQ(variable(1), 15);
}

TEST_P(Supervision, InterruptsOncePerStall) {
  bench.set(AxisParameter::stop_on_stall, 100);
  bench.run_program(R"(
         VECT 15, Stalled
         EI 15
         EI 255
   Loop: JA Loop
Stalled: GGP 1, 2
         CALC ADD, 1
         AGP 1, 2
         RETI
)");
  for (int stalls = 1; stalls <= 3; ++stalls) {
    stall_at(500);
    EXPECT_EQ(variable(1), stalls);
  }
}

TEST_P(Supervision, ForgetsInterruptsOfTheTimeWithoutAProgram) {
  bench.set(AxisParameter::stop_on_stall, 100);
  bench.download("Loop: JA Loop\nStalled: SGP 1, 2, 15\nRETI\n");
  bench.command(Opcode::vect, 15, 0, 1);
  bench.command(Opcode::ei, 15);
  bench.command(Opcode::ei, 255);
  stall_at(500);
  bench.command(Opcode::run_application);
  wait_ms(100);
  EXPECT_EQ(variable(1), 0);
}

/// Which error flags a program finds, as bits in the order of the words of CLE: ETO, EAL, EDV, EPO, ESD.
constexpr auto report_flags = R"(
     Report: CLE ETO
             SGP 1, 2, 0
             JC EAL, Alarm
  NoAlarm:   JC EDV, Deviation
  NoDeviation: JC EPO, Position
  NoPosition: JC ESD, Shutdown
             STOP
  Alarm:     GGP 1, 2
             CALC OR, 2
             AGP 1, 2
             JA NoAlarm
  Deviation: GGP 1, 2
             CALC OR, 4
             AGP 1, 2
             JA NoDeviation
  Position:  GGP 1, 2
             CALC OR, 8
             AGP 1, 2
             JA NoPosition
  Shutdown:  GGP 1, 2
             CALC OR, 16
             AGP 1, 2
             STOP
)";
constexpr std::int32_t edv = 4, epo = 8, esd = 16;

TEST_P(Supervision, TellsTheProgramByErrorFlagsUntilItClearsThem) {
  struct Case {
    const char* name;
    Opcode opcode;
    std::int32_t value;
    void (*prepare)(Bench&);
    std::int32_t expected;
  };
  const Case cases[] = {
      {"nothing happens", Opcode::mvp, 10'000, [](Bench&) {}, 0},
      {"deviation in velocity mode", Opcode::ror, 500,
       [](Bench& b) {
         b.set(AxisParameter::maximum_encoder_deviation, 2000);
         b.set(AxisParameter::chopper_off_time, 0);
       },
       edv},
      {"deviation in a move", Opcode::mvp, 50'000,
       [](Bench& b) {
         b.set(AxisParameter::maximum_encoder_deviation, 2000);
         b.set(AxisParameter::chopper_off_time, 0);
       },
       edv | epo},
      {"stall in a move", Opcode::mvp, 50'000,
       [](Bench& b) {
         b.set(AxisParameter::stop_on_stall, 100);
         b.module.world().set_load_measurement(measured_at_a_stall);
       },
       epo},
      {"a limit switch on the way", Opcode::mvp, 50'000,
       [](Bench& b) {
         b.set(AxisParameter::right_limit_switch_disable, 0);
         b.module.world().set_right_switch(true);
       },
       epo},
      {"a limit switch in velocity mode", Opcode::ror, 500,
       [](Bench& b) {
         b.set(AxisParameter::right_limit_switch_disable, 0);
         b.module.world().set_right_switch(true);
       },
       0},
      {"over-temperature", Opcode::ror, 500, [](Bench& b) { b.module.world().set_temperature(160); }, esd},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    Bench fresh(bench.module.description());
    c.prepare(fresh);
    const std::string begin = c.opcode == Opcode::mvp ? "MVP ABS, 0, " : "ROR 0, ";
    fresh.run_program(begin + std::to_string(c.value) + "\n WAIT TICKS, 0, 100\n" + report_flags);
    fresh.wait(2'000 * one_millisecond);
    EXPECT_EQ(fresh.command(Opcode::ggp, 1, 2).value, c.expected);

    Bench clearing(bench.module.description());
    c.prepare(clearing);
    clearing.run_program(begin + std::to_string(c.value) + "\n WAIT TICKS, 0, 100\n CLE ALL\n" + report_flags);
    clearing.wait(2'000 * one_millisecond);
    EXPECT_EQ(clearing.command(Opcode::ggp, 1, 2).value, 0);
  }
}

TEST(ReferenceSwitchTolerance, KeepsALimitSwitchFromBeingAnObstacle) {
  for (const std::int32_t tolerance : {0, 3'000}) {
    Bench bench(tmcm1110);
    bench.set(AxisParameter::reference_switch_tolerance, tolerance);
    bench.set(AxisParameter::right_limit_switch_disable, 0);
    bench.set(AxisParameter::maximum_acceleration, 1);  // for many looks at a motor that does not turn yet
    bench.module.world().set_right_switch(true);
    bench.run_program("MVP ABS, 0, 2000\nWAIT TICKS, 0, 10\n" + std::string(report_flags));
    bench.wait(1'000 * one_millisecond);
    EXPECT_EQ(bench.command(Opcode::ggp, 1, 2).value, tolerance == 0 ? epo : 0);
  }
}

TEST_P(Supervision, LetsTheModuleSleepWhenTheMotorHasBeenStopped) {
  bench.set(AxisParameter::stop_on_stall, 100);
  bench.set(AxisParameter::maximum_encoder_deviation, 1000);
  stall_at(500);
  wait_ms(3'000);
  EXPECT_EQ(bench.module.next_turn(), never);
}

}  // namespace
}  // namespace opentmcl::tests
