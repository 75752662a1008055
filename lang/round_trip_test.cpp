// Source to binary to source to binary: the binaries are the same, for every program of the repository and for any
// number of generated ones. `RC_PARAMS=max_success=5000 lang_test --gtest_filter=RoundTrip.*` makes the latter a
// million.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lang/assembling_test.hpp"
#include "lang/disassembler.hpp"
#include "lang/formatter.hpp"
#include "lang/generated_program_test.hpp"
#include "lang/program_file.hpp"
#include "lang/repository_programs_test.hpp"

namespace opentmcl::lang {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Assembled {
  Bytes binary;  ///< empty if there are errors
  std::string errors;
};

Assembled assembled(const std::string& path, const std::string& source, const ModuleDescription& module) {
  DiskFiles files;
  AssemblerOptions options;
  options.module = &module;
  options.append_stop = false;
  const AssemblyResult result = assemble(path, source, options, files);
  if (!result.program) return {{}, format(result.diagnostics, result.sources)};
  return {to_program_file(result.program->commands), {}};
}

/// What a binary becomes as a source; empty if it cannot be one.
std::string disassembled(const Bytes& binary, const ModuleDescription& module, Comments comments) {
  const ProgramFileResult program = from_program_file(binary);
  if (!program.commands) return {};
  Disassembly disassembly = disassemble(*program.commands, module, comments);
  return disassembly.problems.empty() ? disassembly.text : std::string();
}

TEST(RoundTrip, KeepsEveryProgramOfTheRepository) {
  for (const RepositoryProgram& program : repository_programs()) {
    std::string errors;
    int modules_it_is_for = 0;
    for (const ModuleDescription& module : modules) {
      const Assembled first = assembled(program.path, program.text, module);
      errors += first.errors;
      if (!first.errors.empty()) continue;
      ++modules_it_is_for;
      for (const Comments comments : {Comments::none, Comments::meanings}) {
        const std::string source = disassembled(first.binary, module, comments);
        EXPECT_EQ(assembled("again.tmc", source, module).binary, first.binary) << program.path << "\n" << source;
      }
    }
    EXPECT_GT(modules_it_is_for, 0) << errors;
  }
}

TEST(RepositoryPrograms, AreFormatted) {
  for (const RepositoryProgram& program : repository_programs()) {
    EXPECT_EQ(format_source(program.text), program.text) << "tmcl fmt " << program.path;
  }
}

RC_GTEST_PROP(RoundTrip, KeepsGeneratedPrograms, (std::uint64_t first_seed)) {
  constexpr std::uint64_t programs_a_case = 200;
  constexpr std::size_t maximum_size = 12;
  for (std::uint64_t seed = first_seed; seed != first_seed + programs_a_case; ++seed) {
    Dice dice(seed);
    const ModuleDescription& module = dice.one_of(modules);
    const std::vector<Command> commands = generated_program(dice, module, dice.below(maximum_size + 1));
    const std::string source = generated_source(dice, module, commands);
    const Assembled first = assembled("generated.tmc", source, module);
    if (!first.errors.empty()) RC_FAIL(first.errors + source);
    RC_ASSERT(first.binary == to_program_file(commands));
    const std::string again = disassembled(first.binary, module, Comments::meanings);
    const Assembled second = assembled("again.tmc", again, module);
    if (second.binary != first.binary) RC_FAIL(second.errors + source + std::string("\nbecame\n").append(again));
    RC_ASSERT(format_source(again) == again);
  }
}

}  // namespace
}  // namespace opentmcl::lang
