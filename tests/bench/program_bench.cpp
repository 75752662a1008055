// Program instructions per second in one process; processor instructions for each are counted by
// program_instructions.py.
#include <benchmark/benchmark.h>

#include <memory>

#include "tests/bench/direct_mode_boards.hpp"
#include "tests/bench/program_loop.hpp"

namespace opentmcl::bench {
namespace {

/// One instruction in each turn of the main loop, time standing still.
template <class Board>
void program(benchmark::State& state) {
  const auto board = std::make_unique<Board>();
  start(*board);
  if (!run_program(*board)) {
    state.SkipWithError("the program does not run");
    return;
  }
  for (auto _ : state) board->module().poll(board->now());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_TEMPLATE(program, RegisterFileBoard)->UseRealTime();

/// The whole twin: 100 µs of simulated time for each instruction.
void twin(benchmark::State& state) {
  MemoryPort port;
  VirtualModule module(pd1161, {{&port, hal::PortKind::usb}});
  const auto execute = [&](const Command& command) {
    port.send(encode(Request{1, command}));
    module.wake();
    module.advance_to(module.now() + 20 * one_millisecond);
  };
  execute(instruction(Opcode::enter_download_mode));
  for (const Command& command : program_loop) execute(command);
  execute(instruction(Opcode::exit_download_mode));
  execute(instruction(Opcode::run_application, 1));
  constexpr Microseconds stretch = 100 * one_millisecond;
  constexpr std::int64_t turns = stretch / VirtualModule::Options{}.turn;
  for (auto _ : state) module.advance_to(module.now() + stretch);
  state.SetItemsProcessed(state.iterations() * turns);
}
BENCHMARK(twin)->UseRealTime();

}  // namespace
}  // namespace opentmcl::bench
