// How much faster than real time a whole virtual module is: firmware, chips, motor and machine.
#include <benchmark/benchmark.h>

#include "tests/bench/moving_module.hpp"

namespace opentmcl::bench {
namespace {

void simulate(benchmark::State& state, const Situation& situation) {
  MovingModule bench;
  situation.begin(bench);
  for (auto _ : state) situation.repeat(bench);
  if (!situation.is_met(bench)) state.SkipWithError("the module does something else");
  const double seconds = static_cast<double>(situation.stretch) * 1e-6 * static_cast<double>(state.iterations());
  state.counters["simulated s/s"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
}

}  // namespace

int main(int argument_count, char** arguments) {
  for (const Situation& situation : measured_situations) {
    benchmark::RegisterBenchmark(situation.name.data(), simulate, situation);
  }
  benchmark::Initialize(&argument_count, arguments);
  if (benchmark::ReportUnrecognizedArguments(argument_count, arguments)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace opentmcl::bench

int main(int argument_count, char** arguments) {
  return opentmcl::bench::main(argument_count, arguments);
}
