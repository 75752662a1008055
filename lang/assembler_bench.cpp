// How fast sources become programs. The source is what a large program looks like: initialisation, comments, labels,
// jumps forward and back, constants, some expressions.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "lang/assembler.hpp"
#include "lang/disassembler.hpp"

namespace opentmcl::lang {
namespace {

constexpr int lines_per_block = 20;

/// Jumps go to labels of the first blocks only: further ones have addresses no jump can hold.
constexpr std::int64_t blocks_with_targets = 3000;

std::string generated_source(std::int64_t block_count) {
  std::string text = "#include TMCLParam.tmc\n";
  for (std::int64_t block = 0; block < block_count; ++block) {
    const std::string n = std::to_string(block);
    const std::string target = std::to_string(block % blocks_with_targets);
    text += "// Block " + n + ": moves there and back, then waits for an input\n";
    text += "Speed" + n + " = 100 + " + std::to_string(block % 1000) + "\n";
    text += "Block" + n + ":\n";
    text += "    SAP APMaxPositioningSpeed, Motor0, Speed" + n + "   // velocity of this block\n";
    text += "    SAP 5, 0, 500\n";
    text += "    MVP ABS, 0, " + std::to_string(block * 100) + "\n";
    text += "    WAIT POS, 0, 0\n";
    text += "    MVP REL, 0, -(200 * 256) / 4\n";
    text += "    WAIT POS, 0, 500 // five seconds at most\n";
    text += "    JC ETO, Late" + target + "\n";
    text += "\n";
    text += "    GIO 0, 1\n";
    text += "    CALC MUL, $10\n";
    text += "    COMP 1000\n";
    text += "    JC GE, Block" + target + "\n";
    text += "    AGP 42, 2\n";
    text += "    WAIT TICKS, 0, 50\n";
    text += "    JA Block" + target + "\n";
    text += "Late" + n + ": CLE ETO\n";
    text += "    MST 0\n";
  }
  return text;
}

AssemblerOptions options() {
  AssemblerOptions unlimited;
  unlimited.check_capacity = false;
  return unlimited;
}

void assemble_source(benchmark::State& state) {
  const std::string source = generated_source(state.range(0));
  MemoryFiles files;
  for (auto _ : state) {
    const AssemblyResult result = assemble("generated.tmc", source, options(), files);
    if (!result.program || !result.diagnostics.empty()) {
      state.SkipWithError("the source does not assemble cleanly");
      break;
    }
    benchmark::DoNotOptimize(result.program->commands.data());
  }
  const auto lines = static_cast<double>(state.iterations()) * static_cast<double>(state.range(0) * lines_per_block);
  state.counters["lines"] = benchmark::Counter(lines, benchmark::Counter::kIsRate);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(source.size()));
}
// A large source with all its jumps to itself, and a million lines.
BENCHMARK(assemble_source)->ArgName("blocks")->Arg(blocks_with_targets)->Arg(50000)->Unit(benchmark::kMillisecond);

void disassemble_program(benchmark::State& state) {
  MemoryFiles files;
  const AssemblyResult result = assemble("generated.tmc", generated_source(blocks_with_targets), options(), files);
  for (auto _ : state) {
    const Disassembly disassembly = disassemble(result.program->commands, pd1161);
    benchmark::DoNotOptimize(disassembly.text.data());
  }
  const auto instructions =
      static_cast<double>(state.iterations()) * static_cast<double>(result.program->commands.size());
  state.counters["instructions"] = benchmark::Counter(instructions, benchmark::Counter::kIsRate);
}
BENCHMARK(disassemble_program)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opentmcl::lang
