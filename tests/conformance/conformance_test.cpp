// Each statement is a test for each module that it is about.
#include <gtest/gtest.h>

#include <exception>
#include <iostream>
#include <string>

#include "tests/conformance/conformance_table.hpp"
#include "tests/conformance/runner.hpp"

namespace opentmcl::conformance {
namespace {

class StatementTest : public testing::Test {
 public:
  StatementTest(const Statement& statement, ModuleId module) : statement_(statement), module_(module) {}

  void TestBody() override {
    try {
      if (const auto failure = run(statement_, module_)) {
        ADD_FAILURE() << "section " << statement_.section << ": " << statement_.says << '\n' << *failure;
      }
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }

 private:
  const Statement& statement_;
  ModuleId module_;
};

void register_tests(const ConformanceTable& table) {
  for (const Statement& statement : table.statements) {
    for (const ModuleDescription& module : modules) {
      if (!contains(statement.modules, module.id)) continue;
      testing::RegisterTest(
          module.argument, statement.id.c_str(), nullptr, nullptr, __FILE__, __LINE__,
          [&statement, id = module.id]() -> testing::Test* { return new StatementTest(statement, id); });
    }
  }
}

}  // namespace
}  // namespace opentmcl::conformance

/// An argument names another folder of tables, for trying out statements.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  try {
    const opentmcl::conformance::ConformanceTable table =
        opentmcl::conformance::read_conformance_table(argc > 1 ? argv[1] : OPENTMCL_CONFORMANCE_TABLES);
    opentmcl::conformance::register_tests(table);
    return RUN_ALL_TESTS();
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
