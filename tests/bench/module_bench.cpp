// How much faster than real time a whole virtual module is: firmware, chips, motor and machine.
#include <benchmark/benchmark.h>

#include <cstdint>

#include "boards/twin/virtual_module.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "tests/bench/direct_mode_boards.hpp"
#include "tests/bench/program_loop.hpp"

namespace opentmcl::bench {
namespace {

/// A module with its real motor on a long stage, and a host at its port.
class Bench {
 public:
  explicit Bench(double load) : module_(pd1161, {{&port_, hal::PortKind::usb}}, options(load)) {
    module_.advance_to(one_millisecond);
  }

  VirtualModule& module() { return module_; }

  /// @return the value of the reply
  std::int32_t execute(const Command& command) {
    port_.send(encode(Request{1, command}));
    module_.wake();
    module_.advance_to(module_.now());
    return decode_reply(port_.reply()).value;
  }
  void set(AxisParameter parameter, std::int32_t value) {
    execute(instruction(Opcode::sap, static_cast<std::uint8_t>(parameter), 0, value));
  }
  std::int32_t get(AxisParameter parameter) {
    return execute(instruction(Opcode::gap, static_cast<std::uint8_t>(parameter)));
  }
  void pass(Microseconds time) { module_.advance_to(module_.now() + time); }

 private:
  static VirtualModule::Options options(double load) {
    twin::LinearStageDimensions stage;
    stage.travel = 2'000'000'000;
    VirtualModule::Options options;
    options.machine = stage;
    options.motor = twin::motors().front();
    options.load = load;
    return options;
  }

  MemoryPort port_;
  VirtualModule module_;
};

constexpr std::int32_t velocity = 1000;  // internal units: 36 rpm

void show_rate(benchmark::State& state, Microseconds stretch) {
  const double seconds = static_cast<double>(stretch) * 1e-6 * static_cast<double>(state.iterations());
  state.counters["simulated s/s"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
}

/// Turning evenly under a load, its position read by a host every 10 ms.
void locked_and_observed(benchmark::State& state) {
  Bench bench(100);  // N: 0.03 N m
  bench.execute(instruction(Opcode::ror, 0, 0, velocity));
  bench.pass(2000 * one_millisecond);
  for (auto _ : state) {
    bench.pass(10 * one_millisecond);
    benchmark::DoNotOptimize(bench.get(AxisParameter::actual_position));
  }
  show_rate(state, 10 * one_millisecond);
}
BENCHMARK(locked_and_observed);

/// A program that drives to and fro: MVP, WAIT POS, MVP, WAIT POS, JA.
void program_with_wait(benchmark::State& state) {
  Bench bench(100);
  constexpr std::uint8_t relative = 1;
  constexpr std::uint8_t position = 1;
  const Command program[] = {
      instruction(Opcode::mvp, relative, 0, 512'000),
      instruction(Opcode::wait, position, 0, 0),
      instruction(Opcode::mvp, relative, 0, -512'000),
      instruction(Opcode::wait, position, 0, 0),
      instruction(Opcode::ja),
  };
  bench.execute(instruction(Opcode::enter_download_mode));
  for (const Command& command : program) {
    bench.execute(command);
    bench.pass(20 * one_millisecond);
  }
  bench.execute(instruction(Opcode::exit_download_mode));
  bench.pass(20 * one_millisecond);
  bench.execute(instruction(Opcode::run_application, 1));
  bench.pass(2000 * one_millisecond);
  for (auto _ : state) bench.pass(1000 * one_millisecond);
  if (bench.module().world().rotor_angle() == 0) state.SkipWithError("the program does not run");
  show_rate(state, 1000 * one_millisecond);
}
BENCHMARK(program_with_wait);

/// In full steps the motor's currents are integrated.
void free_in_full_steps(benchmark::State& state) {
  Bench bench(100);
  bench.set(AxisParameter::microstep_resolution, 0);
  bench.set(AxisParameter::pulse_divisor, 10);
  bench.execute(instruction(Opcode::ror, 0, 0, velocity));
  bench.pass(2000 * one_millisecond);
  for (auto _ : state) bench.pass(10 * one_millisecond);
  if (bench.module().world().motor()->regime() == twin::Regime::locked) state.SkipWithError("the motor is locked");
  show_rate(state, 10 * one_millisecond);
}
BENCHMARK(free_in_full_steps);

/// A second at a time.
void standing_still(benchmark::State& state) {
  Bench bench(100);
  bench.execute(instruction(Opcode::mvp, 1, 0, 51'200));
  bench.pass(20'000 * one_millisecond);
  for (auto _ : state) bench.pass(1000 * one_millisecond);
  show_rate(state, 1000 * one_millisecond);
}
BENCHMARK(standing_still);

}  // namespace
}  // namespace opentmcl::bench
