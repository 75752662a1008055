// Every program of this folder, on the modules it is for; and that together they leave no instruction out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <tuple>

#include "lang/assembler.hpp"
#include "tests/programs/program_run.hpp"

namespace opentmcl::tests {
namespace {

std::vector<std::string> program_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(OPENTMCL_PROGRAMS)) {
    if (entry.path().extension() == ".tmc") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string text_of(const std::string& path) {
  const std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Assembles for one module; fails the test when that is not possible.
TestProgram load(const std::string& name, ModuleId module) {
  TestProgram program{OPENTMCL_PROGRAMS "/" + name + ".tmc", {}, {}};
  const std::string text = text_of(program.path);
  program.script = parse_script(text);
  for (const std::string& error : program.script.errors) ADD_FAILURE() << program.path << ':' << error;
  lang::AssemblerOptions options;
  options.module = &modules[static_cast<std::size_t>(module)];
  lang::DiskFiles files;
  const lang::AssemblyResult result = lang::assemble(program.path, text, options, files);
  EXPECT_TRUE(result.program.has_value()) << lang::format(result.diagnostics, result.sources);
  if (result.program) program.commands = result.program->commands;
  return program;
}

class Programs : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Run, Programs, testing::ValuesIn(program_names()),
                         [](const auto& tested) { return tested.param; });

TEST_P(Programs, AsTheySay) {
  const ProgramScript script = load(GetParam(), ModuleId::pd1161).script;
  EXPECT_FALSE(script.expectations.empty()) << "a program that expects nothing tests nothing";
  for (const ModuleId module : script.modules) {
    const TestProgram program = load(GetParam(), module);
    ProgramRun(program, modules[static_cast<std::size_t>(module)]).execute();
  }
}

/// The field of an instruction that an operand is in.
int field_of(const Command& command, Field field) {
  return field == Field::type ? command.type : command.motor;
}

/// Each instruction, and each word that its operands can be: every condition, event, operation and so on.
TEST(AllPrograms, TogetherUseEveryInstructionWithEveryWord) {
  std::set<std::tuple<std::uint8_t, Field, int>> used;
  std::set<std::uint8_t> opcodes;
  for (const std::string& name : program_names()) {
    for (const Command& command : load(name, ModuleId::pd1161).commands) {
      opcodes.insert(command.opcode);
      for (const Field field : {Field::type, Field::motor}) {
        used.insert({command.opcode, field, field_of(command, field)});
      }
    }
  }
  for (const InstructionSpec& row : instructions) {
    if (row.mnemonic == nullptr) continue;
    const auto opcode = static_cast<std::uint8_t>(row.opcode);
    EXPECT_TRUE(opcodes.contains(opcode)) << row.mnemonic;
    for (const OperandSpec& operand : row.operands) {
      const KeywordSet words = keywords_of(operand.kind);
      for (std::size_t i = 0; i < words.count; ++i) {
        if (words.words[i].value == words.excluded) continue;
        EXPECT_TRUE(used.contains({opcode, operand.field, words.words[i].value}))
            << row.mnemonic << ' ' << words.words[i].word;
      }
    }
  }
}

}  // namespace
}  // namespace opentmcl::tests
