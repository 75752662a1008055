#include "tests/machines/search_trial.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <variant>

#include "tests/module/bench.hpp"
#include "twin/physics/shaft.hpp"

namespace opentmcl::tests {

using twin::CircularAxisDimensions;
using twin::Contact;
using twin::LinearStageDimensions;
using twin::microsteps_per_turn;

namespace {

constexpr std::int32_t microstep_resolution = 4;  // 16 microsteps: fast to simulate
constexpr std::int32_t pulse_divisor = 2;
constexpr std::int32_t ramp_divisor = 4;

/// Switching points are as late as the search looks, which is every millisecond, and as the contact bounces: so slowly
/// that the motor makes less than a full step in that time.
void choose_speeds(Trial& trial, std::int32_t bounce, Dice& dice) {
  const double longest = 1.0 + bounce / 1000.0;
  const auto highest = static_cast<std::int32_t>(0.9 * microsteps_per_full_step / microsteps_per_millisecond / longest);
  trial.slowly = dice.between(highest / 2, highest);
  trial.fast = dice.between(400, 1500);
  trial.acceleration = dice.between(300, 2047);
}

Trial stage_for(const Search& search, Dice& dice) {
  LinearStageDimensions stage;
  stage.pitch = dice.between(1'000, 6'000);
  stage.travel = 2 * dice.between(12'000, 18'000);
  stage.limit_switch_width = dice.between(800, 1'500);
  stage.limit_switch_distance = stage.limit_switch_width + dice.between(500, 1'500);
  stage.mirrored = dice.one_in(3);
  stage.switch_bounce = dice.one_in(3) ? dice.between(500, 6'000) : 0;
  stage.switch_hysteresis = dice.one_in(3) ? dice.between(10, 200) : 0;
  stage.backlash = dice.one_in(3) ? dice.between(10, 200) : 0;
  stage.home_switch_width = 2 * dice.between(300, 700);
  stage.home_switch_center = dice.between(-7'000, 7'000);
  const bool open = search.uses_home_switch() ? search.home_is_low_active() : dice.one_in(2);
  stage.contact = open ? Contact::normally_open : Contact::normally_closed;

  const std::int32_t near = stage.travel / 2 - stage.limit_switch_distance;
  const std::int32_t far = near + stage.limit_switch_width;
  const std::int32_t home_half = stage.home_switch_width / 2;
  Trial trial;
  // A motor at the other end turns left where the stage has its right: the shaft is reversed in the module.
  trial.reversed = stage.mirrored;
  trial.normally_open = open;
  if (search.uses_home_switch()) {
    trial.searched = {double(stage.home_switch_center - home_half), double(stage.home_switch_center + home_half), 0};
  } else if (search.forth() > 0) {
    trial.searched = {double(near), double(far), 0};
  } else {
    trial.searched = {double(-far), double(-near), 0};
  }
  trial.searched.hysteresis = stage.switch_hysteresis;
  // Modes 7 and 8 do not turn back: the switch has to lie ahead. No mode finds a limit switch from behind it.
  const std::int32_t lowest = search.mode() == 7 ? stage.home_switch_center - home_half : -far;
  const std::int32_t highest = search.mode() == 8 ? stage.home_switch_center + home_half : far;
  stage.start = dice.between(lowest, highest);
  trial.start = stage.start;
  trial.backlash = stage.backlash;
  trial.microsteps_per_unit = double(microsteps_per_turn) / stage.pitch;
  choose_speeds(trial, stage.switch_bounce, dice);
  trial.machine = stage;
  return trial;
}

Trial axis_for(const Search& search, Dice& dice) {
  CircularAxisDimensions axis;
  axis.gear_numerator = dice.between(2, 20);
  axis.gear_denominator = dice.between(1, 2);
  axis.start = dice.between(0, 359'999);
  axis.mirrored = dice.one_in(2);
  axis.home_mark_center = dice.between(0, 359'999);
  axis.home_mark_width = 2 * dice.between(2'000, 10'000);
  axis.switch_bounce = dice.one_in(3) ? dice.between(500, 6'000) : 0;
  axis.switch_hysteresis = dice.one_in(3) ? dice.between(10, 1'000) : 0;
  axis.backlash = dice.one_in(3) ? dice.between(10, 1'000) : 0;
  axis.contact = search.home_is_low_active() ? Contact::normally_open : Contact::normally_closed;

  Trial trial;
  const double half = axis.home_mark_width / 2.0;
  trial.searched = {axis.home_mark_center - half, axis.home_mark_center + half, double(axis.switch_hysteresis)};
  trial.start = axis.start;
  trial.backlash = axis.backlash;
  trial.microsteps_per_unit = double(microsteps_per_turn) * axis.gear_numerator / (360'000.0 * axis.gear_denominator);
  trial.period = 360'000;
  trial.direction = axis.mirrored ? -1 : 1;
  choose_speeds(trial, axis.switch_bounce, dice);
  // A mark has to be seen in passing: for some looks of a millisecond after its contact has come to rest.
  const double longest = 3.0 + axis.switch_bounce / 1000.0;
  const double seen = axis.home_mark_width * trial.microsteps_per_unit / longest / microsteps_per_millisecond;
  trial.fast = std::min(trial.fast, static_cast<std::int32_t>(seen));
  trial.machine = axis;
  return trial;
}

/// Where the origin is by the dimensions of the machine: the middle of the two switching points as the search passes
/// them. @return angle of the shaft in microsteps, rising with the place, 0 at the start
double expected_origin(const Search& search, const Trial& trial) {
  const int forth = search.forth() * trial.direction;
  // A slider that is moved to the right follows the shaft by the backlash.
  const double behind_forth = forth > 0 ? trial.backlash : 0.0;
  const double behind_back = forth > 0 ? 0.0 : trial.backlash;
  const double near_edge = forth > 0 ? trial.searched.from : trial.searched.to;
  const double far_edge = forth > 0 ? trial.searched.to : trial.searched.from;
  const double entered = near_edge + behind_forth;
  const double other = search.crosses_the_switch() ? far_edge + forth * trial.searched.hysteresis + behind_forth
                                                   : near_edge - forth * trial.searched.hysteresis + behind_back;
  return ((entered + other) / 2.0 - trial.start) * trial.microsteps_per_unit;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Trial& trial) {
  out << "start " << trial.start << ", switch " << trial.searched.from << " to " << trial.searched.to << ", hysteresis "
      << trial.searched.hysteresis << ", backlash " << trial.backlash << ", direction " << trial.direction << ", fast "
      << trial.fast << ", slowly " << trial.slowly << ", acceleration " << trial.acceleration;
  std::visit(
      [&out](const auto& kind) {
        if constexpr (requires { kind.switch_bounce; }) out << ", bounce " << kind.switch_bounce << " us";
        if constexpr (requires { kind.pitch; }) out << ", pitch " << kind.pitch << ", travel " << kind.travel;
        if constexpr (requires { kind.gear_numerator; }) {
          out << ", gear " << kind.gear_numerator << '/' << kind.gear_denominator;
        }
      },
      trial.machine);
  if (trial.motor) out << ", motor " << trial.motor->name << ", load " << trial.load;
  return out;
}

std::vector<Search> all_searches() {
  std::vector<Search> searches;
  for (const ModuleId module : {ModuleId::tmcm1110, ModuleId::pd1161}) {
    for (const std::int32_t setting : {1, 2, 3, 4, 5, 6, 7, 8, 133, 134, 135, 136}) {
      searches.push_back({module, Kind::linear_stage, setting});
      if ((setting & 15) >= 5) searches.push_back({module, Kind::circular_axis, setting});
    }
  }
  for (const std::int32_t setting : {65, 66, 67, 68}) {
    searches.push_back({ModuleId::pd1161, Kind::linear_stage, setting});
  }
  return searches;
}

std::string name_of(const testing::TestParamInfo<Search>& tested) {
  const Search& search = tested.param;
  return std::string(search.module == ModuleId::pd1161 ? "pd1161" : "tmcm1110") +
         (search.kind == Kind::linear_stage ? "_linear_stage" : "_circular_axis") + "_mode_" +
         std::to_string(search.setting);
}

Dice dice_for(const Search& search) {
  return Dice(static_cast<std::uint32_t>(search.setting) * 4 + static_cast<std::uint32_t>(search.kind) * 2 +
              static_cast<std::uint32_t>(search.module));
}

Trial random_trial(const Search& search, Dice& dice) {
  return search.kind == Kind::linear_stage ? stage_for(search, dice) : axis_for(search, dice);
}

double error_of_zero(const Search& search, const Trial& trial) {
  Bench bench(modules[static_cast<std::size_t>(search.module)], hal::PortKind::usb, nullptr,
              {.machine = trial.machine, .motor = trial.motor, .load = trial.load});
  bench.set(AxisParameter::microstep_resolution, microstep_resolution);
  bench.set(AxisParameter::pulse_divisor, pulse_divisor);
  bench.set(AxisParameter::ramp_divisor, ramp_divisor);
  bench.set(AxisParameter::maximum_acceleration, trial.acceleration);
  bench.set(AxisParameter::reference_search_speed, trial.fast);
  bench.set(AxisParameter::maximum_positioning_speed, trial.fast);  // of the way back to the origin
  bench.set(AxisParameter::reference_switch_speed, trial.slowly);
  bench.set(AxisParameter::reference_search_mode, search.setting);
  bench.set(GlobalParameter::reverse_shaft, trial.reversed ? 1 : 0);
  bench.set(GlobalParameter::end_switch_polarity, trial.normally_open ? 1 : 0);
  bench.command(Opcode::rfs, 0);
  const Microseconds limit = bench.module.now() + 300'000 * one_millisecond;
  while (bench.command(Opcode::rfs, 2).value != 0) {
    if (bench.module.now() > limit) {
      ADD_FAILURE() << "does not end: state " << bench.command(Opcode::rfs, 2).value;
      return 0;
    }
    bench.wait(20 * one_millisecond);
  }
  EXPECT_EQ(bench.get(AxisParameter::actual_position), 0);
  const auto* stage = std::get_if<LinearStageDimensions>(&trial.machine);
  const bool mirrored = stage != nullptr ? stage->mirrored : trial.direction < 0;
  const double angle = static_cast<double>(bench.module.world().rotor_angle()) * (mirrored ? -1 : 1);
  const double error = angle - expected_origin(search, trial);
  // One mark is as good as another.
  const double period = trial.period * trial.microsteps_per_unit;
  return period == 0 ? error : std::remainder(error, period);
}

}  // namespace opentmcl::tests
