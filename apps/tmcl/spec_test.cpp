#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/tmcl/spec_json.hpp"
#include "apps/tmcl/spec_words.hpp"
#include "lang/expression.hpp"

namespace opentmcl::app {
namespace {

using Json = nlohmann::json;

TEST(Spec, HasEveryRowOfEveryTable) {
  const Json spec = Json::parse(spec_as_json());
  EXPECT_EQ(module_count, spec.at("modules").size());
  EXPECT_EQ(instruction_count, spec.at("instructions").size());
  EXPECT_EQ(axis_parameter_count, spec.at("axis_parameters").size());
  EXPECT_EQ(global_parameter_count, spec.at("global_parameters").size());
  EXPECT_EQ(interrupt_count, spec.at("interrupts").size());
  EXPECT_EQ(std::size(status_codes), spec.at("status_codes").size());
  EXPECT_EQ(io_port_count, spec.at("io_ports").size());
  EXPECT_EQ(lang::function_count, spec.at("functions").size());
}

TEST(Spec, ShowsAParameterWithItsColumns) {
  const Json parameters = Json::parse(spec_as_json()).at("axis_parameters");
  const Json& row = parameters.at(4);
  EXPECT_EQ(4, row.at("number"));
  EXPECT_EQ("APMaxPositioningSpeed", row.at("symbol"));
  EXPECT_EQ("RWE", row.at("modules").at("pd1161").at("access"));
  EXPECT_EQ(2047, row.at("modules").at("tmcm1110").at("maximum"));
}

TEST(Spec, LeavesOutTheColumnOfAModuleThatLacksTheParameter) {
  const Json spec = Json::parse(spec_as_json());
  for (const Json& row : spec.at("axis_parameters")) {
    if (row.at("number") == static_cast<unsigned>(AxisParameter::boost_current)) {
      EXPECT_FALSE(row.at("modules").contains("tmcm1110"));
    }
  }
}

TEST(Spec, GivesTheWordsOfAnOperand) {
  const Json spec = Json::parse(spec_as_json());
  for (const Json& row : spec.at("instructions")) {
    if (row.at("mnemonic") != "MVP") continue;
    EXPECT_EQ("ABS", row.at("operands").at(0).at("words").at(0).at("word"));
    return;
  }
  FAIL() << "no MVP";
}

TEST(Spec, NamesEveryInstructionInItsText) {
  const std::string text = spec_as_text();
  for (const InstructionSpec& row : instructions) {
    if (row.mnemonic == nullptr) continue;
    EXPECT_NE(std::string::npos, text.find(std::string("  ") + row.mnemonic)) << row.mnemonic;
  }
  EXPECT_NE(std::string::npos, text.find("MVP ABS|REL|COORD, motor_group, position"));
}

}  // namespace
}  // namespace opentmcl::app
