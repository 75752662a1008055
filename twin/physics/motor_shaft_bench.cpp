// Simulated seconds per second of one core, for each regime of a motor on its own.
#include "twin/physics/motor_shaft.hpp"

#include <benchmark/benchmark.h>

namespace opentmcl::twin {
namespace {

/// Turns evenly at `velocity` (electrical turns per second) in spans of the longest that the regime allows.
void turn(benchmark::State& state, double velocity, bool always_free) {
  MotorShaft shaft(motors().front(), std::make_shared<TorqueTables>());
  Load load;
  load.inertia = 1e-5;
  load.torque = 0.1;
  shaft.set_load(load);
  Field field{.amplitude = shaft.motor().rated_amplitude(), .energised = true};
  const auto advance = [&] {
    const Tick span = shaft.longest_span(field);
    shaft.advance_to(shaft.now() + span, field);
    field.angle = field.angle_after(static_cast<double>(span) * seconds_per_tick);
    return span;
  };
  for (; field.velocity < velocity; field.velocity += 1) advance();
  field.velocity = velocity;
  while (shaft.now() < 20'000 * ticks_per_millisecond) advance();
  shaft.set_always_free(always_free);

  double simulated = 0;
  std::int64_t sum = 0;
  for (auto _ : state) {
    simulated += static_cast<double>(advance()) * seconds_per_tick;
    benchmark::DoNotOptimize(sum += shaft.stall_guard_measurement());
  }
  state.counters["simulated_s"] = benchmark::Counter(simulated, benchmark::Counter::kIsRate);
}

void locked(benchmark::State& state) {
  turn(state, 200, false);
}
void locked_beyond_the_voltage_limit(benchmark::State& state) {
  turn(state, 900, false);
}
void free_regime(benchmark::State& state) {
  turn(state, 200, true);
}
void at_rest(benchmark::State& state) {
  turn(state, 0, false);
}

BENCHMARK(locked);
BENCHMARK(locked_beyond_the_voltage_limit);
BENCHMARK(free_regime);
BENCHMARK(at_rest);

/// A row of a torque table, at a speed where the supply is the limit.
void torque_table_row(benchmark::State& state) {
  const MotorData& motor = motors().front();
  double amplitude = 3.96;
  for (auto _ : state) {
    TorqueTables tables;
    amplitude += 1e-6;
    const auto table = tables.table(motor, TorqueTables::key(24, amplitude, 25));
    benchmark::DoNotOptimize(table->pull_out_torque(1000));  // two rows
  }
}
BENCHMARK(torque_table_row);

}  // namespace
}  // namespace opentmcl::twin
