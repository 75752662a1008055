#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "server/control_methods.hpp"

namespace opentmcl::server {
namespace {

TEST(ControlReference, IsInTheDocument) {
  std::ifstream file(OPENTMCL_DOCUMENTS "/control.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(std::string::npos, document.find(control_reference()))
      << "docs/control.md has another table of methods than this one:\n"
      << control_reference();
}

TEST(ControlReference, HasAllMethods) {
  for (const ControlMethod& method : control_methods()) {
    EXPECT_NE(std::string::npos, control_reference().find("**" + std::string(method.name) + "**"));
    EXPECT_EQ(&method, find_control_method(method.name));
  }
}

}  // namespace
}  // namespace opentmcl::server
