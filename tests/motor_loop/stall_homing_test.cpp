// Homing without a switch: examples/scenarios/stall_homing.tmc finds the hard end by stallGuard2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "firmware/chip/tmc262_registers.hpp"
#include "tests/motor_loop/motor_bench.hpp"

namespace opentmcl::tests {
namespace {

std::string program() {
  const std::ifstream file(OPENTMCL_EXAMPLES "/scenarios/stall_homing.tmc");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Homes on a machine of 40 mm travel. @param start µm
/// @return where position 0 is, in microsteps from the hard end on
double place_of_zero(ModuleId module, std::int32_t start) {
  VirtualModule::Options options;
  auto& stage = std::get<twin::LinearStageDimensions>(options.machine);
  stage.travel = 40'000;
  stage.start = start;
  options.motor = twin::motors().front();
  MotorBench bench(modules[static_cast<std::size_t>(module)], options);
  bench.run_program(program());
  const twin::World& world = bench.world();
  const auto is_ready = [&world] { return (world.outputs() & hal::bit(hal::OutputPin::out0)) != 0; };
  for (int looks = 0; looks < 1'000 && !is_ready(); ++looks) bench.wait_ms(10);
  EXPECT_TRUE(is_ready());
  bench.wait_ms(200);
  // The run-up may have ended at the hard end on the right.
  constexpr double electrical_turn = tmc262::microstep_positions;
  const auto rotor = static_cast<double>(world.rotor_angle());
  const double behind = std::remainder(world.present_field().angle * electrical_turn - rotor, electrical_turn);
  EXPECT_NEAR(behind, 0, full_step / 16.0) << "the slider is where it should be";
  const double field = rotor + behind;
  return field - static_cast<double>(world.machine().travel().lowest) - bench.position();
}

class StallHoming : public testing::TestWithParam<ModuleId> {};

INSTANTIATE_TEST_SUITE_P(Both, StallHoming, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161), name_of_module);

/// Where within four full steps the end is belongs to a machine and remains: at power on the rotor falls into a place
/// that the field holds, so starts of one machine differ by whole turns of the currents.
TEST_P(StallHoming, FindsTheSamePlaceWithinAFullStepFromEverywhere) {
  constexpr std::int32_t electrical_turn = 40;  // µm
  std::mt19937 random(1);
  int precise_machines = 0;
  for (std::int32_t machine = 0; machine < electrical_turn; ++machine) {
    double nearest = 1e9;
    double furthest = -1e9;
    for (int i = 0; i < 8; ++i) {
      const std::int32_t start = machine + electrical_turn * (static_cast<std::int32_t>(random() % 991) - 495);
      SCOPED_TRACE(testing::Message() << "start at " << start << " um");
      const double zero = place_of_zero(GetParam(), start);
      nearest = std::min(nearest, zero);
      furthest = std::max(furthest, zero);
    }
    EXPECT_LE(furthest - nearest, full_step);
    // Beyond the end, where the motor pushed, but not so far that it fell back.
    EXPECT_GE(nearest, -2 * full_step);
    EXPECT_LE(furthest, 0);
    if (furthest - nearest < full_step / 16.0) ++precise_machines;
  }
  // On the others a full step ends as the slider comes to the end, and it or the next one is measured as a stall.
  EXPECT_GE(precise_machines, electrical_turn * 3 / 4);
}

}  // namespace
}  // namespace opentmcl::tests
