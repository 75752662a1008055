#include "scenario/unit.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "twin/world/quantities.hpp"

namespace opentmcl::scenario {
namespace {

double number(std::string_view text, std::string_view unit) {
  const Parsed<double> parsed = parse_number(text, unit);
  if (const auto* const error = std::get_if<TextError>(&parsed)) ADD_FAILURE() << text << ": " << error->message;
  return std::holds_alternative<double>(parsed) ? std::get<double>(parsed) : 0;
}

std::string error(std::string_view text, std::string_view unit) {
  const Parsed<double> parsed = parse_number(text, unit);
  const auto* const found = std::get_if<TextError>(&parsed);
  return found == nullptr ? "" : std::to_string(found->offset) + ' ' + found->message;
}

TEST(Number, IsConvertedToTheUnitThatIsWanted) {
  EXPECT_EQ(number("24 V", "V"), 24);
  EXPECT_EQ(number("18500mV", "V"), 18.5);
  EXPECT_EQ(number("30 ms", "us"), 30'000);
  EXPECT_EQ(number("0.1 s", "us"), 100'000);
  EXPECT_EQ(number("1.5 h", "s"), 5400);
  EXPECT_EQ(number("12 mm", "mm"), 12);
  EXPECT_EQ(number("35 um", "mm"), 0.035);
  EXPECT_EQ(number("800 mNm", "N m"), 0.8);
  EXPECT_EQ(number("0.8 N m", "Nm"), 0.8);
  EXPECT_EQ(number("68 g cm2", "kg m2"), 68e-7);
  EXPECT_EQ(number("-40 °C", "degC"), -40);
  EXPECT_NEAR(number("3.141592653589793 rad", "deg"), 180, 1e-12);
}

TEST(Number, WithoutAUnitIsInTheOneThatIsWanted) {
  EXPECT_EQ(number("24", "V"), 24);
  EXPECT_EQ(number("-1e3", ""), -1000);
  EXPECT_EQ(number("7  ", "mm"), 7);
}

TEST(Number, WithAWrongUnitIsRefusedWithTheNearestOne) {
  EXPECT_EQ(error("24 v", "V"),
            "3 'v' is not the unit of a voltage: expected a voltage such as 1.5 V; did you mean V?");
  EXPECT_EQ(error("24 mm", "V"), "3 'mm' is not the unit of a voltage: expected a voltage such as 1.5 V");
  EXPECT_EQ(error("24 V", ""), "3 'V' behind a plain number: expected no unit");
  EXPECT_EQ(error("24 V now", "V"), "5 'now' is not the unit of a voltage: expected a voltage such as 1.5 V");
  EXPECT_EQ(error("much", "V"), "0 expected a voltage such as 1.5 V, found 'much'");
  EXPECT_EQ(error("", "V"), "0 expected a voltage such as 1.5 V, found nothing");
  EXPECT_EQ(error("inf", "V"), "0 expected a voltage such as 1.5 V, found 'inf'");
}

TEST(Number, TakesOnlyWhatBelongsToIt) {
  EXPECT_EQ(std::get<NumberWithUnit>(take_number("0.8 N m and so on", "Nm")).length, 7u);
  EXPECT_EQ(std::get<NumberWithUnit>(take_number("5 and so on", "V")).length, 1u);
}

TEST(Units, AreKnownForEveryQuantity) {
  for (const twin::Quantity& quantity : twin::quantities()) {
    EXPECT_TRUE(quantity.unit.empty() || find_unit(quantity.unit) != nullptr) << quantity.name << ": " << quantity.unit;
  }
}

RC_GTEST_PROP(Number, IsTheSameInEveryUnitOfItsDimension, (std::int16_t whole)) {
  for (const Unit& from : units()) {
    for (const Unit& to : units()) {
      if (from.dimension != to.dimension) continue;
      const double there = number(std::to_string(whole) + ' ' + std::string(from.name), to.name);
      const double back = number(twin::text_of(there) + ' ' + std::string(to.name), from.name);
      RC_ASSERT(std::abs(back - whole) <= 1e-9);
    }
  }
}

}  // namespace
}  // namespace opentmcl::scenario
