// Conversations with the debug adapter as files: conversations/README.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "editor/dap/debugging_client_test.hpp"

namespace opentmcl::editor::dap {
namespace {

constexpr std::string_view client_mark = "client: ";
constexpr std::string_view server_mark = "server: ";
constexpr std::string_view file_mark = "file: ";
constexpr std::string_view folder_mark = "$FOLDER";
constexpr std::string_view anything = "*";

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

json parsed(std::string_view line, std::string_view mark) {
  json value = json::parse(line.substr(mark.size()), nullptr, false);
  EXPECT_FALSE(value.is_discarded()) << "not JSON: " << line;
  return value;
}

/// Whether the actual value is the expected one, in which "*" stands for any value.
bool matches(const json& expected, const json& actual) {
  if (expected == anything) return true;
  if (expected.type() != actual.type() || expected.size() != actual.size()) return expected == actual;
  if (expected.is_object()) {
    return std::all_of(expected.items().begin(), expected.items().end(), [&](const auto& item) {
      return actual.contains(item.key()) && matches(item.value(), actual[item.key()]);
    });
  }
  if (expected.is_array()) return std::equal(expected.begin(), expected.end(), actual.begin(), matches);
  return expected == actual;
}

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// An adapter, and a folder with the files of the conversation.
class Conversation {
 public:
  /// @return what the adapter says to a line of the client, a message or an array of them that come at once
  std::vector<json> say(const std::string& line) {
    const json messages = parsed(replaced(line, folder_mark, folder_.path()), client_mark);
    for (const json& message : messages.is_array() ? messages : json::array({messages})) put(message);
    std::vector<json> said = client_.listen();
    for (json& message : said) {
      message.erase("seq");
      message = json::parse(replaced(message.dump(), folder_.path(), folder_mark));
    }
    return said;
  }

  void add_file(const std::string& line) const {
    const json file = parsed(line, file_mark);
    folder_.write(file.value("name", ""), file.value("text", ""));
  }

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

void replay(const std::string& path) {
  Conversation conversation;
  std::vector<json> said;
  std::size_t number = 0;
  const auto expect_silence = [&] {
    for (const json& message : said) {
      ADD_FAILURE() << path << ": before line " << number << " the adapter also says\n" << server_mark << message;
    }
    said.clear();
  };
  for (const std::string& line : lines_of(path)) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    if (line.starts_with(client_mark)) {
      expect_silence();
      said = conversation.say(line);
    } else if (line.starts_with(file_mark)) {
      conversation.add_file(line);
    } else if (!line.starts_with(server_mark)) {
      ADD_FAILURE() << path << ":" << number << ": expected client:, server:, file: or #";
    } else if (said.empty()) {
      ADD_FAILURE() << path << ":" << number << ": the adapter says nothing; expected\n" << line;
    } else {
      EXPECT_TRUE(matches(parsed(line, server_mark), said.front())) << path << ":" << number << ": expected\n"
                                                                    << line << "\nbut the adapter says\n"
                                                                    << server_mark << said.front();
      said.erase(said.begin());
    }
  }
  expect_silence();
}

void record(const std::string& path) {
  Conversation conversation;
  std::string text;
  // What the file expects is kept where it is right, because it may say less than the adapter does.
  std::vector<std::string> expected;
  std::vector<json> said;
  const auto finish_answers = [&] {
    for (std::size_t i = 0; i < said.size(); ++i) {
      const bool is_right = i < expected.size() && matches(parsed(expected[i], server_mark), said[i]);
      text += (is_right ? expected[i] : std::string(server_mark) + said[i].dump()) + '\n';
    }
    said.clear();
    expected.clear();
  };
  for (const std::string& line : lines_of(path)) {
    if (line.starts_with(server_mark)) {
      expected.push_back(line);
      continue;
    }
    finish_answers();
    text += line + '\n';
    if (line.starts_with(file_mark)) conversation.add_file(line);
    if (line.starts_with(client_mark)) said = conversation.say(line);
  }
  finish_answers();
  std::ofstream(path) << text;
}

std::vector<std::string> conversations() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(OPENTMCL_CONVERSATIONS)) {
    if (entry.path().extension() == ".conversation") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class DebugConversation : public testing::TestWithParam<std::string> {};

TEST_P(DebugConversation, GoesAsItIsWritten) {
  const std::string path = std::string(OPENTMCL_CONVERSATIONS) + "/" + GetParam() + ".conversation";
  if (std::getenv("OPENTMCL_RECORD") != nullptr) record(path);
  replay(path);
}

INSTANTIATE_TEST_SUITE_P(Recorded, DebugConversation, testing::ValuesIn(conversations()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace opentmcl::editor::dap
