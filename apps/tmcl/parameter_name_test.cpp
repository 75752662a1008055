#include "apps/tmcl/parameter_name.hpp"

#include <gtest/gtest.h>

namespace opentmcl::app {
namespace {

TEST(ParameterName, IsANumberASymbolOrAName) {
  for (const char* text :
       {"1", "APActualPosition", "actualposition", "actual position", "Actual-Position", "actual_position"}) {
    const auto found = find_axis_parameter(text);
    ASSERT_TRUE(found.ok()) << text;
    EXPECT_EQ(1, found->number) << text;
    EXPECT_EQ(Unit::microsteps, found->unit);
  }
}

TEST(ParameterName, FindsEveryRowBySymbolAndByName) {
  for (const AxisParameterSpec& row : axis_parameters) {
    EXPECT_EQ(static_cast<std::uint8_t>(row.number), find_axis_parameter(row.symbol)->number);
    EXPECT_EQ(static_cast<std::uint8_t>(row.number), find_axis_parameter(row.name)->number);
  }
  for (const GlobalParameterSpec& row : global_parameters) {
    EXPECT_EQ(static_cast<std::uint8_t>(row.number), find_global_parameter(row.symbol, Bank::module_settings)->number);
    EXPECT_EQ(static_cast<std::uint8_t>(row.number), find_global_parameter(row.name, Bank::module_settings)->number);
  }
}

TEST(ParameterName, MayBeANumberNoTableHas) {
  EXPECT_EQ(99, find_axis_parameter("99")->number);
  EXPECT_TRUE(find_axis_parameter("99")->symbol.empty());
  EXPECT_EQ(42, find_global_parameter("42", Bank::user_variables)->number);
}

TEST(ParameterName, OfAnInterruptSettingIsTheInterrupts) {
  EXPECT_EQ(0, find_global_parameter("TI_TIMER0", Bank::interrupt_settings)->number);
  EXPECT_EQ(27, find_global_parameter("left stop switch 0", Bank::interrupt_settings)->number);
}

TEST(ParameterName, SuggestsWhatItIsPartOf) {
  const auto found = find_axis_parameter("acceleration");
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(client::ErrorKind::usage, found.error().kind);
  EXPECT_NE(std::string::npos, found.error().message.find("APMaxAcceleration"));
  EXPECT_FALSE(find_axis_parameter("256").ok());
  EXPECT_FALSE(find_axis_parameter("-1").ok());
  EXPECT_FALSE(find_axis_parameter("").ok());
}

}  // namespace
}  // namespace opentmcl::app
