// The example extension in a module, asked by a host and by a program; and modules without extension.
#include "examples/extension/measurements.hpp"

#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::examples {
namespace {

using tests::Bench;

constexpr auto customer_bank = static_cast<std::uint8_t>(Bank::customer);
constexpr auto variables = static_cast<std::uint8_t>(Bank::user_variables);

class ExtendedModule : public testing::TestWithParam<ModuleId> {
 protected:
  static VirtualModule::Options extended_by(const Extensions& extensions) {
    VirtualModule::Options options;
    options.extensions = &extensions;
    return options;
  }

  Measurements measurements;
  Extensions extensions = measurements.extensions();
  Bench bench{modules[static_cast<std::size_t>(GetParam())], hal::PortKind::usb, nullptr, extended_by(extensions)};
};

INSTANTIATE_TEST_SUITE_P(Both, ExtendedModule, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(ExtendedModule, HasVariablesInBankOne) {
  for (std::uint8_t n = 0; n < Measurements::count; ++n) {
    EXPECT_EQ(bench.command(Opcode::sgp, n, customer_bank, n * 50'000'000).status, Status::ok);
  }
  for (std::uint8_t n = 0; n < Measurements::count; ++n) {
    const Reply reply = bench.command(Opcode::ggp, n, customer_bank);
    EXPECT_EQ(reply.status, Status::ok);
    EXPECT_EQ(reply.value, n * 50'000'000);
  }
  EXPECT_EQ(bench.command(Opcode::ggp, 0, variables).value, 0) << "they are not the user variables";
}

TEST_P(ExtendedModule, RefusesVariablesThatDoNotExist) {
  EXPECT_EQ(bench.command(Opcode::sgp, Measurements::count, customer_bank, 1).status, Status::wrong_type);
  EXPECT_EQ(bench.command(Opcode::ggp, Measurements::count, customer_bank).status, Status::wrong_type);
}

TEST_P(ExtendedModule, AnswersUserFunctions) {
  EXPECT_EQ(bench.command(Opcode::uf2, 3, 5, -7).status, Status::ok);
  bench.command(Opcode::sgp, 4, customer_bank, 100);
  EXPECT_EQ(bench.command(Opcode::uf0, 0, 31).value, 86);
  EXPECT_EQ(bench.command(Opcode::uf1, 3, 5).value, 100);
  EXPECT_EQ(bench.command(Opcode::uf1, 3, 3).value, -7);
  EXPECT_EQ(bench.command(Opcode::uf0, 5, 3).status, Status::wrong_type);
  EXPECT_EQ(bench.command(Opcode::uf0, 0, 32).status, Status::wrong_type);
}

TEST_P(ExtendedModule, RefusesUserFunctionsThatItDoesNotHave) {
  for (const Opcode opcode : {Opcode::uf3, Opcode::uf4, Opcode::uf5, Opcode::uf6, Opcode::uf7}) {
    EXPECT_EQ(bench.command(opcode).status, Status::invalid_command) << static_cast<int>(opcode);
  }
}

TEST_P(ExtendedModule, GivesAProgramItsResultsInTheAccumulator) {
  bench.run_program(
      "SGP 0, 1, 20\nCALC LOAD, 22\nAGP 1, 1\n"
      "UF0 0, 1, 0\nJC LE, End\nAGP 0, 2\n"  // 42, which is greater than 0
      "UF2 0, 1, -5\nAGP 1, 2\n"             // answers -5, and leaves the accumulator alone
      "UF0 1, 0, 0\nAGP 2, 2\n"              // no range: the program goes on
      "GGP 0, 1\nAGP 3, 2\n"
      "End: STOP\n");
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(bench.command(Opcode::ggp, 0, variables).value, 42);
  EXPECT_EQ(bench.command(Opcode::ggp, 1, variables).value, 42);
  EXPECT_EQ(bench.command(Opcode::ggp, 2, variables).value, 42);
  EXPECT_EQ(bench.command(Opcode::ggp, 3, variables).value, -5);
}

TEST_P(ExtendedModule, EndsAProgramAtAUserFunctionThatItDoesNotHave) {
  bench.run_program("SGP 0, 2, 1\nUF7 0, 0, 0\nSGP 0, 2, 2\n");
  bench.wait(100 * one_millisecond);
  EXPECT_EQ(bench.command(Opcode::ggp, 0, variables).value, 1);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
}

/// Is busy until it has been called a number of times.
struct Conversion {
  int calls = 0;

  static Outcome convert(void* context, const Command&) {
    auto& self = *static_cast<Conversion*>(context);
    constexpr int calls_needed = 3;
    if (++self.calls < calls_needed) return {Status::ok, 0, Outcome::Form::busy};
    return {Status::ok, self.calls, Outcome::Form::result};
  }
};

TEST(SlowUserFunction, IsCalledAgainUntilItIsDone) {
  for (const bool in_program : {false, true}) {
    Conversion conversion;
    Extensions extensions;
    extensions.context = &conversion;
    extensions.user_functions[6] = Conversion::convert;
    VirtualModule::Options options;
    options.extensions = &extensions;
    Bench bench(pd1161, hal::PortKind::usb, nullptr, options);
    if (in_program) {
      bench.run_program("UF6 0, 0, 0\nAGP 0, 2\n");
      bench.wait(20 * one_millisecond);
      EXPECT_EQ(bench.command(Opcode::ggp, 0, variables).value, 3);
    } else {
      EXPECT_EQ(bench.command(Opcode::uf6).value, 3);
    }
    EXPECT_EQ(conversion.calls, 3);
  }
}

TEST(ModuleWithoutExtension, RefusesUserFunctionsAndBankOne) {
  Bench bench(pd1161);
  for (int number = 0; number < static_cast<int>(user_function_count); ++number) {
    const auto opcode = static_cast<Opcode>(static_cast<int>(Opcode::uf0) + number);
    EXPECT_EQ(bench.command(opcode).status, Status::invalid_command) << "UF" << number;
  }
  EXPECT_EQ(bench.command(Opcode::sgp, 0, customer_bank, 1).status, Status::invalid_value);
  EXPECT_EQ(bench.command(Opcode::ggp, 0, customer_bank).status, Status::invalid_value);
}

}  // namespace
}  // namespace opentmcl::examples
