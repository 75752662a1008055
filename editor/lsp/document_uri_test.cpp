#include "editor/lsp/document_uri.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <string>

namespace opentmcl::editor::lsp {
namespace {

TEST(DocumentUri, IsThePathOfAFile) {
  EXPECT_EQ(path_of_uri("file:///lab/my%20axis.tmc"), "/lab/my axis.tmc");
  EXPECT_EQ(path_of_uri("file://localhost/lab/a.tmc"), "/lab/a.tmc");
  EXPECT_EQ(path_of_uri("file:///lab/../gr%C3%BC%c3%9fe.tmc"),
            "/gr\xC3\xBC\xC3\x9F"
            "e.tmc");
  EXPECT_EQ(path_of_uri("file:///50%.tmc"), "/50%.tmc");
}

TEST(DocumentUri, IsNoPathOfAnythingElse) {
  EXPECT_EQ(path_of_uri("untitled:Untitled-1"), std::nullopt);
  EXPECT_EQ(path_of_uri("file:"), std::nullopt);
  EXPECT_EQ(path_of_uri("file://"), std::nullopt);
  EXPECT_EQ(path_of_uri("file:///a%00b"), std::nullopt);
  EXPECT_EQ(path_of_uri(""), std::nullopt);
}

RC_GTEST_PROP(DocumentUri, OfAPathLeadsBackToIt, (std::string name)) {
  for (char& c : name) {
    if (c == '/' || c == '\0') c = '_';
  }
  const std::string path = "/lab/x" + name;
  RC_ASSERT(path_of_uri(uri_of_path(path)) == path);
}

}  // namespace
}  // namespace opentmcl::editor::lsp
