#include "editor/dap/used_variables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lang/assembler.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::editor::dap {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::set<std::uint8_t> variables_of(std::string text) {
  lang::MemoryFiles files;
  const lang::AssemblyResult result = lang::assemble("my.tmc", std::move(text), {}, files);
  return result.program ? used_variables(result.program->commands, ModuleId::pd1161) : std::set<std::uint8_t>{255};
}

TEST(UsedVariables, AreThoseOfBank2) {
  EXPECT_THAT(variables_of("SGP 7, 2, 1\nGGP 3, 2\nAGP 40, 2\nSTGP 5, 2\nRSGP 6, 2\n"), ElementsAre(3, 5, 6, 7, 40));
  EXPECT_THAT(variables_of("SGP 75, 0, 1\nGGP 3, 3\nSAP 4, 0, 2\nGAP 2, 0\n"), IsEmpty());
}

TEST(UsedVariables, AreThoseThatArithmeticNames) {
  EXPECT_THAT(variables_of("CALCVV ADD, 1, 2\nCALCV LOAD, 3, 100\nCALCVA ADD, 4\nLoop: DJNZ 8, Loop\n"),
              ElementsAre(1, 2, 3, 4, 8));
}

}  // namespace
}  // namespace opentmcl::editor::dap
