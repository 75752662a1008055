// Conversations with the debug adapter as files: conversations/README.md.

#include <gtest/gtest.h>

#include <string_view>

#include "editor/dap/debugging_client_test.hpp"
#include "editor/message_conversation_test.hpp"

namespace opentmcl::editor::dap {
namespace {

constexpr std::string_view folder_mark = "$FOLDER";

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// An adapter, and a folder with the files of the conversation.
class AdapterAndFolder final : public ConversationPartner {
 public:
  /// @param text a message, or an array of them that come at once
  std::vector<json> answers_to(const std::string& text) override {
    const json messages = parsed_message(replaced(text, folder_mark, folder_.path()));
    for (const json& message : messages.is_array() ? messages : json::array({messages})) put(message);
    std::vector<json> said = client_.listen();
    for (json& message : said) {
      message.erase("seq");
      message = json::parse(replaced(message.dump(), folder_.path(), folder_mark));
    }
    return said;
  }

  void add_file(const json& file) override { folder_.write(file.value("name", ""), file.value("text", "")); }

 private:
  void put(json message) {
    message["type"] = "request";
    message["seq"] = ++last_number_;
    client_.stream().write(message);
  }

  TestFolder folder_;
  DebuggingClient client_;
  int last_number_ = 0;
};

class DebugConversation : public testing::TestWithParam<std::string> {};

TEST_P(DebugConversation, GoesAsItIsWritten) {
  expect_as_written<AdapterAndFolder>(OPENTMCL_CONVERSATIONS, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Recorded, DebugConversation, testing::ValuesIn(conversations_in(OPENTMCL_CONVERSATIONS)),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace opentmcl::editor::dap
