#include "scenario/schema.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace opentmcl::scenario {
namespace {

std::string content_of(const std::string& name) {
  std::ifstream file(OPENTMCL_DOCUMENTS "/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(Documents, AreWhatTheTablesSay) {
  EXPECT_TRUE(content_of("scenario.schema.json") == scenario_schema())
      << "make it anew: tmcl scenario schema > docs/scenario.schema.json";
  EXPECT_TRUE(content_of("signals.md") == signals_document())
      << "make it anew: tmcl scenario signals > docs/signals.md";
}

TEST(Schema, KnowsNestedAndQuotedNames) {
  const auto schema = nlohmann::json::parse(scenario_schema());
  const auto& assignments = schema.at("$defs").at("assignments").at("properties");
  EXPECT_EQ(assignments.at("left_switch").at("properties").at("held_open"), assignments.at("left_switch.held_open"));
  EXPECT_FALSE(assignments.contains("position"));
  EXPECT_EQ(schema.at("properties").at("event").at("items").at("additionalProperties"), false);
}

}  // namespace
}  // namespace opentmcl::scenario
