// How fast the TMC429 model lets time pass. Figures and commands: docs/performance.md.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "firmware/chip/tmc429_registers.hpp"
#include "twin/chip/tmc429.hpp"
#include "twin/chip/tmc429_ramp_reference.hpp"

namespace opentmcl::twin {
namespace {

using tmc429::RampMode;

constexpr std::uint64_t second = tmc429::clock_frequency;
constexpr std::uint64_t millisecond = second / 1000;
constexpr std::int32_t ten_turns = 10 * 200 * 256;  // microsteps

/// Counts what it hears, as little as a listener can do.
struct StepCounter : StepListener {
  std::uint64_t steps_heard = 0;
  void steps(const StepRun& run) override { steps_heard += run.count; }
};

struct Chip {
  StepCounter counter;
  Tmc429 tmc429{counter};

  /// 51,208.5 steps/s, reached in 1.1 s.
  Chip() {
    write(tmc429::InterfaceConfiguration::EnableStepDir::set);
    write(tmc429::GlobalParameters::StepPulseLength::of(0));
    write(tmc429::MinimumVelocity::Value::of(1));
    write(tmc429::MaximumVelocity::Value::of(1678));
    write(tmc429::MaximumAcceleration::Value::of(100));
    write(tmc429::Dividers::Pulse::of(3) | tmc429::Dividers::Ramp::of(7));
    write(tmc429::BrakingFactor::Multiplier::of(190) | tmc429::BrakingFactor::Divisor::of(9));
  }

  template <class Register>
  void write(tmc429::Word<Register> word) {
    tmc429.transfer(tmc429::write_datagram(word));
  }
};

/// Simulated seconds per second, from simulated clocks.
benchmark::Counter simulated(std::uint64_t clocks) {
  return {static_cast<double>(clocks) / static_cast<double>(second), benchmark::Counter::kIsRate};
}

/// Ten turns to and fro without a pause, looked at at equal distances.
void move_polled(benchmark::State& state) {
  const auto interval = static_cast<std::uint64_t>(state.range(0)) * millisecond;
  Chip chip;
  std::int32_t target = 0;
  for (auto _ : state) {
    if (chip.tmc429.motion().position == target) {
      target = ten_turns - target;
      chip.write(tmc429::TargetPosition::Value::of(target));
    }
    chip.tmc429.advance(interval);
  }
  state.counters["simulated_s_per_s"] = simulated(chip.tmc429.clock());
}
BENCHMARK(move_polled)->ArgName("ms")->Arg(1)->Arg(10)->Arg(100);

/// Each pass is one move of ten turns.
void whole_move(benchmark::State& state) {
  Chip chip;
  std::int32_t target = 0;
  for (auto _ : state) {
    target = ten_turns - target;
    chip.write(tmc429::TargetPosition::Value::of(target));
    chip.tmc429.advance(13 * second);
  }
  state.counters["simulated_s_per_s"] = simulated(chip.tmc429.clock());
}
BENCHMARK(whole_move);

/// velocity_mode, the direction reversed every second.
void reversals(benchmark::State& state) {
  Chip chip;
  chip.write(tmc429::Mode::of(RampMode::velocity));
  std::int32_t velocity = 1678;
  for (auto _ : state) {
    velocity = -velocity;
    chip.write(tmc429::TargetVelocity::Value::of(velocity));
    chip.tmc429.advance(second);
  }
  state.counters["simulated_s_per_s"] = simulated(chip.tmc429.clock());
}
BENCHMARK(reversals);

void standing_still(benchmark::State& state) {
  Chip chip;
  for (auto _ : state) {
    chip.tmc429.advance(10 * millisecond);
  }
  state.counters["simulated_s_per_s"] = simulated(chip.tmc429.clock());
}
BENCHMARK(standing_still);

/// The clock of every step of ten turns to and fro.
void edges_listed(benchmark::State& state) {
  Chip chip;
  std::vector<std::uint64_t> clocks;
  std::int32_t target = 0;
  std::uint64_t edges = 0;
  for (auto _ : state) {
    if (chip.tmc429.motion().position == target) {
      target = ten_turns - target;
      chip.write(tmc429::TargetPosition::Value::of(target));
    }
    clocks.clear();
    chip.tmc429.advance_listing(100 * millisecond, clocks);
    benchmark::DoNotOptimize(clocks.data());
    edges += clocks.size();
  }
  state.counters["edges_per_s"] = {static_cast<double>(edges), benchmark::Counter::kIsRate};
  state.counters["simulated_s_per_s"] = simulated(chip.tmc429.clock());
}
BENCHMARK(edges_listed);

/// The same, told one by one.
void edges_told(benchmark::State& state) {
  Chip chip;
  chip.tmc429.set_detail(StepDetail::edges);
  chip.write(tmc429::TargetPosition::Value::of((1 << 23) - 1));
  for (auto _ : state) {
    chip.tmc429.advance(10 * millisecond);
  }
  state.counters["edges_per_s"] = {static_cast<double>(chip.counter.steps_heard), benchmark::Counter::kIsRate};
}
BENCHMARK(edges_told)->Iterations(10'000);

/// What the leaps are compared with: the same move tick by tick.
void reference(benchmark::State& state) {
  Tmc429RampReference ramp;
  ramp.state.settings = {.target_position = (1 << 23) - 1,
                         .minimum_velocity = 1,
                         .maximum_velocity = 1678,
                         .maximum_acceleration = 100,
                         .multiplier = 190,
                         .divisor = 9,
                         .pulse_divider = 3,
                         .ramp_divider = 7};
  std::vector<Tmc429RampReference::Step> steps;
  for (auto _ : state) {
    steps.clear();
    ramp.advance(ramp.state.now + 10 * millisecond / tmc429::clock_prescaler, steps);
  }
  state.counters["simulated_s_per_s"] = simulated(ramp.state.now * tmc429::clock_prescaler);
}
BENCHMARK(reference)->Iterations(10'000);

}  // namespace
}  // namespace opentmcl::twin
