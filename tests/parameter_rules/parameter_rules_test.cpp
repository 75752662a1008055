// A million random commands to each module: it and the reference agree on every one.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/parameter_rules/command_stream.hpp"

namespace opentmcl::tests {
namespace {

/// Always the same unless OPENTMCL_SEED says otherwise.
std::uint64_t seed() {
  const char* const text = std::getenv("OPENTMCL_SEED");
  return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

constexpr std::size_t parts_per_module = 4;
constexpr std::size_t streams_per_part = 500;
constexpr std::size_t commands_per_stream = 500;
static_assert(parts_per_module * streams_per_part * commands_per_stream == 1'000'000);

class RandomCommands : public testing::TestWithParam<std::tuple<ModuleId, std::size_t>> {};

INSTANTIATE_TEST_SUITE_P(AMillion, RandomCommands,
                         testing::Combine(testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                                          testing::Range(std::size_t{0}, parts_per_module)),
                         [](const auto& tested) {
                           return std::string(std::get<0>(tested.param) == ModuleId::pd1161 ? "pd1161" : "tmcm1110") +
                                  "_part_" + std::to_string(std::get<1>(tested.param));
                         });

TEST_P(RandomCommands, AreAnsweredByTheRules) {
  const auto [module, part] = GetParam();
  std::mt19937_64 random(seed() * parts_per_module + part);
  for (std::size_t i = 0; i < streams_per_part; ++i) {
    const Stream stream = random_stream(module, commands_per_stream, random);
    if (!find_difference(module, stream)) continue;
    const Stream shortest = shortest_with_difference(module, stream);
    FAIL() << "OPENTMCL_SEED=" << seed() << ", stream " << i << ", shortened to\n"
           << mnemonics(shortest) << find_difference(module, shortest)->text;
  }
}

TEST(Stream, NamesItsCommandsAsOneTypesThem) {
  const Stream stream = {{Step::Kind::command, Step::Recipient::module, {5, 4, 0, 2048}},
                         {Step::Kind::command, Step::Recipient::group, {19, 9, 0, -7}},
                         {Step::Kind::power_cycle, Step::Recipient::module, {}}};
  EXPECT_EQ(mnemonics(stream), "SAP 4, 0, 2048\nCALC LOAD, -7   (to the secondary address)\n(power off and on)\n");
}

}  // namespace
}  // namespace opentmcl::tests
