#include "scenario/condition.hpp"

#include <gtest/gtest.h>

namespace opentmcl::scenario {
namespace {

Condition condition(std::string_view text) {
  Parsed<Condition> parsed = parse_condition(text);
  if (const auto* const error = std::get_if<TextError>(&parsed)) {
    ADD_FAILURE() << text << ": " << error->message;
    return {};
  }
  return std::get<Condition>(std::move(parsed));
}

std::string error(std::string_view text) {
  const Parsed<Condition> parsed = parse_condition(text);
  const auto* const found = std::get_if<TextError>(&parsed);
  return found == nullptr ? "" : std::to_string(found->offset) + ' ' + found->message;
}

class AtTheBench : public testing::Test {
 protected:
  AtTheBench() {
    world.set_supply_voltage(18'500);
    world.set_temperature(60);
    world.set_inputs(0b100);
  }
  bool holds(std::string_view text) const { return condition(text).holds(world); }

  twin::World world;
};

TEST_F(AtTheBench, ComparesAQuantityWithANumber) {
  EXPECT_TRUE(holds("supply_voltage < 24 V"));
  EXPECT_TRUE(holds("supply_voltage <= 18500 mV"));
  EXPECT_FALSE(holds("supply_voltage < 18.5"));
  EXPECT_TRUE(holds("supply_voltage=18.5"));
  EXPECT_FALSE(holds("supply_voltage != 18.5 V"));
  EXPECT_TRUE(holds("supply_voltage >= 18.5"));
  EXPECT_FALSE(holds("supply_voltage > 18.5"));
  EXPECT_TRUE(holds("temperature > -5 degC"));
}

TEST_F(AtTheBench, ComparesWithATolerance) {
  EXPECT_TRUE(holds("supply_voltage = 18 V within 500 mV"));
  EXPECT_FALSE(holds("supply_voltage = 18 V within 499 mV"));
}

TEST_F(AtTheBench, ComparesTwoQuantities) {
  EXPECT_TRUE(holds("position = target_position"));
  EXPECT_FALSE(holds("inputs <= outputs"));
}

TEST_F(AtTheBench, TakesATruthAsItIs) {
  EXPECT_TRUE(holds("input.2"));
  EXPECT_FALSE(holds("not input.2"));
  EXPECT_TRUE(holds("not input.3"));
}

TEST_F(AtTheBench, JoinsAndMoreCloselyThanOr) {
  EXPECT_TRUE(holds("input.2 or input.3 and input.4"));
  EXPECT_FALSE(holds("input.3 and input.4 or input.5"));
  EXPECT_TRUE(holds("input.3 and input.4 or input.2 and temperature = 60"));
}

TEST_F(AtTheBench, TellsEachValueOnce) {
  EXPECT_EQ(condition("supply_voltage > 20 V or input.2 and supply_voltage > 10 V").values(world),
            "supply_voltage is 18.5 V, input.2 is 1");
}

TEST(Condition, NamesTheMistakeAndItsPlace) {
  EXPECT_EQ(error("positoin > 5"), "0 there is no quantity 'positoin': did you mean position?");
  EXPECT_EQ(error("position > 5 and inptu.3"), "17 there is no quantity 'inptu.3': did you mean input.3?");
  EXPECT_EQ(error("position"), "8 expected < <= = != >= or > behind position, found the end");
  EXPECT_EQ(error("position is 5"), "9 expected < <= = != >= or > behind position, found 'is'");
  EXPECT_EQ(error("not position = 5"), "13 'not' only stands before a truth, not before a comparison");
  EXPECT_EQ(error("position => 5"), "9 expected < <= = != >= or >, found '=>'");
  EXPECT_EQ(error("position > 5 mm"), "13 'mm' behind a plain number: expected no unit");
  EXPECT_EQ(error("position > 5 xor input.2"), "13 expected 'and', 'or' or the end, found 'xor'");
  EXPECT_EQ(error("position > 5 within 3"), "13 'within' only stands behind =");
  EXPECT_EQ(error("position = 5 within -3"), "20 expected a tolerance that is not negative");
  EXPECT_EQ(error("position = supply_voltage"),
            "11 supply_voltage in V cannot be compared with position without a unit");
  EXPECT_EQ(error("position > "), "11 expected a number, found nothing");
  EXPECT_EQ(error(""), "0 expected the name of a quantity, found the end");
  EXPECT_EQ(error("position > 5 and"), "16 expected the name of a quantity, found the end");
}

}  // namespace
}  // namespace opentmcl::scenario
