// Conversations with the language server as files: conversations/README.md.

#include <gtest/gtest.h>

#include <utility>

#include "editor/lsp/language_server.hpp"
#include "editor/message_conversation_test.hpp"

namespace opentmcl::editor::lsp {
namespace {

/// A server, and what it has said.
class Server final : public ConversationPartner {
 public:
  Server() : server_([this](const json& message) { said_.push_back(message); }, files_) {}

  std::vector<json> answers_to(const std::string& text) override {
    json message = parsed_message(text);
    if (message.is_object()) message["jsonrpc"] = "2.0";
    server_.take(message);
    server_.publish();
    for (json& answer : said_) answer.erase("jsonrpc");
    return std::exchange(said_, {});
  }

  void add_file(const json& file) override { files_.set(file.value("path", ""), file.value("text", "")); }
  int exit_code() const override { return server_.exit_code().value_or(-1); }

 private:
  lang::MemoryFiles files_;
  std::vector<json> said_;
  LanguageServer server_;
};

class Conversation : public testing::TestWithParam<std::string> {};

TEST_P(Conversation, GoesAsItIsWritten) {
  expect_as_written<Server>(OPENTMCL_CONVERSATIONS, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Recorded, Conversation, testing::ValuesIn(conversations_in(OPENTMCL_CONVERSATIONS)),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace opentmcl::editor::lsp
