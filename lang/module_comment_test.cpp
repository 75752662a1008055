#include "lang/module_comment.hpp"

#include <gtest/gtest.h>

#include <string>

namespace opentmcl::lang {
namespace {

const ModuleDescription* module_of(std::string_view text) {
  const std::optional<ModuleComment> comment = module_named_in(text);
  return comment ? comment->module : nullptr;
}

TEST(ModuleComment, NamesTheModuleOfASource) {
  EXPECT_EQ(module_of("// module: tmcm1110\nSTOP\n"), &tmcm1110);
  EXPECT_EQ(module_of("// module: pd1161"), &pd1161);
  EXPECT_EQ(module_of("; Module:TMCM-1110 and a remark\r\n"), &tmcm1110);
  EXPECT_EQ(module_of("//\tMODULE : Pd-1161\r"), &pd1161);
}

TEST(ModuleComment, StandsAnywhereBeforeTheFirstStatement) {
  EXPECT_EQ(module_of("\xEF\xBB\xBF// Homing\n\n  // by hand\n   // module: tmcm1110\nSTOP"), &tmcm1110);
  EXPECT_EQ(module_named_in("STOP\n// module: tmcm1110\n"), std::nullopt);
  EXPECT_EQ(module_named_in("STOP // module: tmcm1110\n"), std::nullopt);
}

TEST(ModuleComment, IsTheFirstOne) {
  EXPECT_EQ(module_of("// module: tmcm1110\n// module: pd1161\n"), &tmcm1110);
}

TEST(ModuleComment, IsNoOtherComment) {
  for (const char* text :
       {"", "// modules: tmcm1110", "// module tmcm1110", "// for module: tmcm1110", "/ module: pd1161"}) {
    EXPECT_EQ(module_named_in(text), std::nullopt) << text;
  }
}

TEST(ModuleComment, TellsWhatWasWrittenWhereThereIsNoSuchModule) {
  const std::string text = "// module: tmcm1140 x\n";
  const std::optional<ModuleComment> comment = module_named_in(text);
  ASSERT_TRUE(comment);
  EXPECT_EQ(comment->module, nullptr);
  EXPECT_EQ(comment->written, "tmcm1140");
  EXPECT_EQ(comment->written.data(), text.data() + 11);
  EXPECT_EQ(module_named_in("// module:")->written, "");
}

}  // namespace
}  // namespace opentmcl::lang
