#include "editor/lsp/conversation_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "editor/lsp/language_server.hpp"

namespace opentmcl::editor::lsp {
namespace {

constexpr std::string_view client_mark = "client: ";
constexpr std::string_view server_mark = "server: ";
constexpr std::string_view file_mark = "file: ";
constexpr std::string_view exit_mark = "exit: ";
constexpr std::string_view anything = "*";

bool begins_with(std::string_view line, std::string_view mark) {
  return line.substr(0, mark.size()) == mark;
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

/// A server, and what it has said.
class Server {
 public:
  Server() : server_([this](const json& message) { said_.push_back(message); }, files_) {}

  void take(json message) {
    if (message.is_object()) message["jsonrpc"] = "2.0";
    server_.take(message);
    server_.publish();
  }

  void add_file(const json& file) { files_.set(file.value("path", ""), file.value("text", "")); }

  std::vector<json> take_said() {
    for (json& message : said_) message.erase("jsonrpc");
    return std::exchange(said_, {});
  }

  int exit_code() const { return server_.exit_code().value_or(-1); }

 private:
  lang::MemoryFiles files_;
  std::vector<json> said_;
  LanguageServer server_;
};

}  // namespace

std::vector<std::string> conversations_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".conversation") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void replay(const std::string& path) {
  Server server;
  std::vector<json> said;
  std::size_t number = 0;
  const auto expect_silence = [&] {
    for (const json& message : said) {
      ADD_FAILURE() << path << ": before line " << number << " the server also says\n" << server_mark << message;
    }
    said.clear();
  };
  for (const std::string& line : lines_of(path)) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    if (begins_with(line, client_mark)) {
      expect_silence();
      server.take(parsed(line, client_mark));
      said = server.take_said();
    } else if (begins_with(line, file_mark)) {
      server.add_file(parsed(line, file_mark));
    } else if (begins_with(line, exit_mark)) {
      EXPECT_EQ(line.substr(exit_mark.size()), std::to_string(server.exit_code())) << path << ":" << number;
    } else if (!begins_with(line, server_mark)) {
      ADD_FAILURE() << path << ":" << number << ": expected client:, server:, file:, exit: or #";
    } else if (said.empty()) {
      ADD_FAILURE() << path << ":" << number << ": the server says nothing; expected\n" << line;
    } else {
      EXPECT_TRUE(matches(parsed(line, server_mark), said.front())) << path << ":" << number << ": expected\n"
                                                                    << line << "\nbut the server says\n"
                                                                    << server_mark << said.front();
      said.erase(said.begin());
    }
  }
  expect_silence();
}

void record(const std::string& path) {
  Server server;
  std::string text;
  // What the file expects is kept where it is right, because it may say less than the server does.
  std::vector<std::string> expected;
  std::vector<json> said;
  const auto finish_answers = [&] {
    for (std::size_t i = 0; i < said.size(); ++i) {
      const bool is_right = i < expected.size() && matches(parsed(expected[i], server_mark), said[i]);
      text += is_right ? expected[i] : std::string(server_mark) + said[i].dump();
      text += '\n';
    }
    said.clear();
    expected.clear();
  };
  for (const std::string& line : lines_of(path)) {
    if (begins_with(line, server_mark)) {
      expected.push_back(line);
      continue;
    }
    finish_answers();
    text += line + '\n';
    if (begins_with(line, file_mark)) server.add_file(parsed(line, file_mark));
    if (!begins_with(line, client_mark)) continue;
    server.take(parsed(line, client_mark));
    said = server.take_said();
  }
  finish_answers();
  std::ofstream(path) << text;
}

namespace {

class Conversation : public testing::TestWithParam<std::string> {};

TEST_P(Conversation, GoesAsItIsWritten) {
  const std::string path = std::string(OPENTMCL_CONVERSATIONS) + "/" + GetParam() + ".conversation";
  if (std::getenv("OPENTMCL_RECORD") != nullptr) record(path);
  replay(path);
}

INSTANTIATE_TEST_SUITE_P(Recorded, Conversation, testing::ValuesIn(conversations_in(OPENTMCL_CONVERSATIONS)),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace opentmcl::editor::lsp
