#include "apps/tmcl/quantity.hpp"

#include <gtest/gtest.h>

#include "server/pace.hpp"

namespace opentmcl::app {
namespace {

TEST(Duration, IsANumberAndAUnit) {
  EXPECT_EQ(5'000'000U, parse_duration("5s").value());
  EXPECT_EQ(500'000U, parse_duration("500ms").value());
  EXPECT_EQ(120'000'000U, parse_duration("2min").value());
  EXPECT_EQ(5'400'000'000U, parse_duration("1.5h").value());
  EXPECT_EQ(0U, parse_duration("0us").value());
}

TEST(Duration, IsNothingElse) {
  for (const char* text : {"", "5", "s", "-1s", "5 s", "5sec", "nans", "infs", "1e300h", "5s "}) {
    EXPECT_FALSE(parse_duration(text).ok()) << text;
  }
}

TEST(Speed, IsAFactorOrMax) {
  EXPECT_EQ(1, parse_speed("1").value());
  EXPECT_EQ(0.1, parse_speed("0.1").value());
  EXPECT_EQ(server::Pace::maximum, parse_speed("max").value());
  for (const char* text : {"", "0", "-1", "fast", "1x", "inf"}) EXPECT_FALSE(parse_speed(text).ok()) << text;
}

}  // namespace
}  // namespace opentmcl::app
