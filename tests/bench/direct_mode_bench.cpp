// Time per direct-mode command; instructions per command are counted by direct_mode_instructions.py.
#include <benchmark/benchmark.h>

#include <memory>

#include "tests/bench/direct_mode_feeds.hpp"

namespace opentmcl::bench {
namespace {

template <class Feed, class Board>
void direct_mode(benchmark::State& state) {
  const auto board = std::make_unique<Board>();
  const MixRequests requests;
  if (const MixedCommand* wrong = warm_up<Feed>(*board, requests)) {
    state.SkipWithError(wrong->name);
    return;
  }
  for (auto _ : state) {
    for (std::size_t i = 0; i < direct_mode_mix_size; ++i) Feed::exchange(*board, requests[i]);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(direct_mode_mix_size));
}

BENCHMARK_TEMPLATE(direct_mode, Handle, RegisterFileBoard);
BENCHMARK_TEMPLATE(direct_mode, WholeDatagram, RegisterFileBoard);
BENCHMARK_TEMPLATE(direct_mode, ByteByByte, RegisterFileBoard);
BENCHMARK_TEMPLATE(direct_mode, Handle, ModelBoard);
BENCHMARK_TEMPLATE(direct_mode, WholeDatagram, ModelBoard);
BENCHMARK_TEMPLATE(direct_mode, ByteByByte, ModelBoard);

}  // namespace
}  // namespace opentmcl::bench
