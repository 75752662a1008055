// How fast sources become programs. The source is what a large program looks like: initialisation, comments, labels,
// jumps forward and back, constants, some expressions.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>

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

AssemblerOptions options(bool check_program = false) {
  AssemblerOptions unlimited;
  unlimited.check_capacity = false;
  unlimited.check_program = check_program;
  // Jumps go to the first labels only, so that the others are not used.
  unlimited.switched_off.set(index_of(DiagnosticKind::unused_label));
  unlimited.switched_off.set(index_of(DiagnosticKind::too_many_warnings));
  return unlimited;
}

/// A file on disk for the time of a benchmark.
class SourceFileOnDisk {
 public:
  explicit SourceFileOnDisk(const std::string& text)
      : path_((std::filesystem::temp_directory_path() / ("assembler_bench." + std::to_string(std::random_device()())))
                  .string()) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~SourceFileOnDisk() { std::filesystem::remove(path_); }
  SourceFileOnDisk(const SourceFileOnDisk&) = delete;
  SourceFileOnDisk& operator=(const SourceFileOnDisk&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Reads a file and assembles it; the checks of the whole program are run or not.
void assemble_file(benchmark::State& state) {
  const std::string source = generated_source(state.range(0));
  const SourceFileOnDisk file(source);
  DiskFiles files;
  const AssemblerOptions chosen = options(state.range(1) != 0);
  for (auto _ : state) {
    FileContent content = files.read(file.path());
    const AssemblyResult result = assemble(file.path(), std::move(content.text), chosen, files);
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
BENCHMARK(assemble_file)
    ->ArgNames({"blocks", "checks"})
    ->ArgsProduct({{blocks_with_targets, 50000}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

/// What is given as source by mistake or by malice; one kind of trouble, 10 MB of it.
std::string hostile_source(std::int64_t kind) {
  constexpr std::size_t size = 10'000'000;
  std::string text;
  const auto fill = [&](const auto& piece) {
    for (std::size_t i = 0; text.size() < size; ++i) text += piece(i);
  };
  switch (kind) {
    case 0:  // one line
      fill([](std::size_t) { return std::string("MST 0, "); });
      break;
    case 1:  // labels
      fill([](std::size_t i) { return std::string("L").append(std::to_string(i)).append(":\n"); });
      break;
    case 2:  // deep expressions
      fill([](std::size_t) { return std::string("COMP ").append(60000, '(').append("\n"); });
      break;
    case 3:  // names that are not defined, with labels they may be taken for
      fill([](std::size_t i) {
        std::string line = i < 5000 ? "La" : "JA Lb";
        return line.append(std::to_string(i)).append(i < 5000 ? ":\n" : "\n");
      });
      break;
    case 4:  // labels defined twice, many in a line
      fill([](std::size_t i) { return i % 20000 == 0 ? "\n" : "a:"; });
      break;
    case 5:  // no text
      fill([](std::size_t i) { return std::string(1, static_cast<char>(i * 2654435761U >> 13U)); });
      break;
    case 6:  // comments that switch off what does not exist
      fill([](std::size_t) { return "MST 1 // no-warning: no-such-moter\n"; });
      break;
    default:  // calls, each of the next instruction, and loops around all of them
      fill(
          [](std::size_t i) { return std::string("CSUB ").append(std::to_string(i % 65536)).append("\nSTGP 1, 2\n"); });
  }
  return text;
}

void refuse_hostile_source(benchmark::State& state) {
  const std::string source = hostile_source(state.range(0));
  MemoryFiles files;
  for (auto _ : state) {
    const AssemblyResult result = assemble("hostile.tmc", source, options(true), files);
    benchmark::DoNotOptimize(format(result.diagnostics, result.sources).size());
  }
}
BENCHMARK(refuse_hostile_source)->ArgName("kind")->DenseRange(0, 7)->Iterations(1)->Unit(benchmark::kMillisecond);

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
