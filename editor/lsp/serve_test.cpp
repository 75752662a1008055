#include "editor/lsp/serve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace opentmcl::editor::lsp {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// All that a client sends before the server reads anything, and what it has sent back until it ended. Both are files,
/// which take any amount and end where they end.
class Conversation {
 public:
  void send(json message) {
    message["jsonrpc"] = "2.0";
    EXPECT_TRUE(DescriptorStream(-1, sent_.descriptor()).write(message));
  }
  void send_bytes(const std::string& bytes) {
    EXPECT_EQ(::write(sent_.descriptor(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }

  ServeResult serve_to_the_end() {
    sent_.rewind();
    DescriptorStream server(sent_.descriptor(), answered_.descriptor());
    lang::MemoryFiles files;
    return serve(server, files);
  }

  std::vector<json> answers() {
    answered_.rewind();
    DescriptorStream client(answered_.descriptor(), -1);
    std::vector<json> messages;
    while (true) {
      const ReadOutcome outcome = client.read({});
      if (outcome.state != ReadOutcome::State::message) return messages;
      messages.push_back(outcome.message);
    }
  }

  void open_with(const std::string& text) {
    send({{"id", 0}, {"method", "initialize"}, {"params", {{"capabilities", json::object()}}}});
    send({{"method", "initialized"}, {"params", json::object()}});
    send({{"method", "textDocument/didOpen"},
          {"params", {{"textDocument", {{"uri", uri}, {"languageId", "tmcl"}, {"version", 1}, {"text", text}}}}}});
  }
  void change(int version, const std::string& text) {
    send(
        {{"method", "textDocument/didChange"},
         {"params", {{"textDocument", {{"uri", uri}, {"version", version}}}, {"contentChanges", {{{"text", text}}}}}}});
  }
  void end() {
    send({{"id", "end"}, {"method", "shutdown"}});
    send({{"method", "exit"}});
  }

  static constexpr const char* uri = "file:///lab/main.tmc";

 private:
  /// A file without a name, gone at the end.
  class TemporaryFile {
   public:
    TemporaryFile() : file_(std::tmpfile(), &std::fclose) { EXPECT_NE(file_, nullptr); }
    int descriptor() const { return ::fileno(file_.get()); }
    void rewind() const { EXPECT_EQ(::lseek(descriptor(), 0, SEEK_SET), 0); }

   private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  };

  TemporaryFile sent_;
  TemporaryFile answered_;
};

std::vector<json> codes_and_ids(const std::vector<json>& messages) {
  std::vector<json> list;
  list.reserve(messages.size());
  for (const json& message : messages) {
    list.push_back({message.value("id", json()), message.contains("error") ? message["error"]["code"] : json()});
  }
  return list;
}

TEST(Serve, AnswersUntilTheClientSaysExit) {
  Conversation conversation;
  conversation.open_with("STOP\n");
  conversation.end();
  const ServeResult result = conversation.serve_to_the_end();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.error, "");
  EXPECT_THAT(codes_and_ids(conversation.answers()), ElementsAre(json({0, nullptr}), json({"end", nullptr})));
}

TEST(Serve, DoesNotDoWhatHasBeenCancelled) {
  Conversation conversation;
  conversation.open_with("STOP\n");
  conversation.send({{"id", 1}, {"method", "workspace/symbol"}, {"params", {{"query", ""}}}});
  conversation.send({{"id", 2}, {"method", "workspace/symbol"}, {"params", {{"query", ""}}}});
  conversation.send({{"method", "$/cancelRequest"}, {"params", {{"id", 2}}}});
  conversation.send({{"method", "$/cancelRequest"}, {"params", {{"id", 77}}}});
  conversation.end();
  conversation.serve_to_the_end();
  const std::vector<json> answers = codes_and_ids(conversation.answers());
  EXPECT_THAT(answers, testing::UnorderedElementsAre(json({0, nullptr}), json({1, nullptr}), json({2, -32800}),
                                                     json({"end", nullptr})));
}

TEST(Serve, PublishesOnceForManyChanges) {
  Conversation conversation;
  conversation.open_with("STOP\n");
  for (int version = 2; version < 100; ++version) conversation.change(version, "NOSUCH " + std::to_string(version));
  EXPECT_EQ(conversation.serve_to_the_end().exit_code, 1) << "the client has gone without a word";
  const std::vector<json> answers = conversation.answers();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[1]["params"]["version"], 99);
}

TEST(Serve, RefusesABodyThatIsNoJsonAndGoesOn) {
  Conversation conversation;
  conversation.send_bytes("Content-Length: 5\r\n\r\n{\"id\"");
  conversation.open_with("STOP\n");
  conversation.end();
  EXPECT_EQ(conversation.serve_to_the_end().exit_code, 0);
  EXPECT_THAT(codes_and_ids(conversation.answers()),
              ElementsAre(json({nullptr, -32700}), json({0, nullptr}), json({"end", nullptr})));
}

TEST(Serve, SurvivesMessagesThatAreNestedDeeply) {
  const auto framed = [](const std::string& body) {
    return "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  };
  constexpr std::size_t depth = 10'000;
  const std::string nested = std::string(depth, '[') + std::string(depth, ']');
  Conversation conversation;
  conversation.send_bytes(framed(nested));
  conversation.send_bytes(framed(R"({"method":"$/cancelRequest","params":{"id":)" + nested + "}}"));
  conversation.send_bytes(framed(R"({"method":"initialize","id":)" + nested + "}"));
  conversation.send_bytes(framed(std::string(depth, '[')));
  conversation.open_with("STOP\n");
  conversation.end();
  EXPECT_EQ(conversation.serve_to_the_end().exit_code, 0);
  EXPECT_THAT(codes_and_ids(conversation.answers()),
              ElementsAre(json({nullptr, -32600}), json({nullptr, -32600}), json({nullptr, -32700}), json({0, nullptr}),
                          json({"end", nullptr})));
}

TEST(Serve, EndsWhereNoMessageCanBeFoundAnyMore) {
  Conversation conversation;
  conversation.open_with("STOP\n");
  conversation.send_bytes("GET / HTTP/1.1\r\n\r\n");
  const ServeResult result = conversation.serve_to_the_end();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.error, HasSubstr("expected a header field"));
  EXPECT_EQ(conversation.answers().size(), 2U) << "what came before is answered";
}

}  // namespace
}  // namespace opentmcl::editor::lsp
