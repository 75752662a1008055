#include "lang/include_files.hpp"

#include <gtest/gtest.h>

#include "lang/assembling_test.hpp"

namespace opentmcl::lang {
namespace {

TEST(IncludeFiles, DefineTheNamesTheManualsUse) {
  const std::vector<Command> commands = commands_of(
      "#include TMCLParam.tmc\n"
      "#include Interrupts.inc\n"
      "SAP APMaxPositioningSpeed, Motor0, 1000\n"
      "SAP APMaxAcceleration, Motor0, 500\n"
      "EI TI_TIMER0\n"
      "EI TI_GLOBAL\n");
  EXPECT_THAT(commands, testing::ElementsAre(command(Opcode::sap, 4, 0, 1000), command(Opcode::sap, 5, 0, 500),
                                             command(Opcode::ei, 0), command(Opcode::ei, 255)));
}

TEST(IncludeFiles, AssembleWithoutComplaintForEveryModule) {
  for (const ModuleDescription& module : modules) {
    EXPECT_TRUE(problems_of("#include tmclparam.TMC\n#include INTERRUPTS.INC\n#include TMCLParam.tmc", module).empty());
  }
}

TEST(IncludeFiles, HaveOnlyWhatTheModuleHas) {
  EXPECT_NE(parameter_file(pd1161).find("APBoostCurrent"), std::string::npos);
  EXPECT_EQ(parameter_file(tmcm1110).find("APBoostCurrent"), std::string::npos);
  EXPECT_NE(interrupt_file(tmcm1110).find("TI_INPUT5"), std::string::npos);
  EXPECT_EQ(interrupt_file(pd1161).find("TI_INPUT5"), std::string::npos);
}

TEST(IncludeFiles, AreNoOthers) {
  EXPECT_EQ(built_in_file("Other.inc", pd1161), std::nullopt);
}

}  // namespace
}  // namespace opentmcl::lang
