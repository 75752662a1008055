#include "editor/message_conversation_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace opentmcl::editor {

using nlohmann::json;

namespace {

constexpr std::string_view client_mark = "client: ";
constexpr std::string_view server_mark = "server: ";
constexpr std::string_view file_mark = "file: ";
constexpr std::string_view exit_mark = "exit: ";
constexpr std::string_view anything = "*";

json parsed(const std::string& line, std::string_view mark) {
  return parsed_message(line.substr(mark.size()));
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

}  // namespace

json parsed_message(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  EXPECT_FALSE(value.is_discarded()) << "not JSON: " << text;
  return value;
}

std::vector<std::string> conversations_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".conversation") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void replay(const std::string& path, ConversationPartner& partner) {
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
    if (line.starts_with(client_mark)) {
      expect_silence();
      said = partner.answers_to(line.substr(client_mark.size()));
    } else if (line.starts_with(file_mark)) {
      partner.add_file(parsed(line, file_mark));
    } else if (line.starts_with(exit_mark)) {
      EXPECT_EQ(line.substr(exit_mark.size()), std::to_string(partner.exit_code())) << path << ":" << number;
    } else if (!line.starts_with(server_mark)) {
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

void record(const std::string& path, ConversationPartner& partner) {
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
    if (line.starts_with(server_mark)) {
      expected.push_back(line);
      continue;
    }
    finish_answers();
    text += line + '\n';
    if (line.starts_with(file_mark)) partner.add_file(parsed(line, file_mark));
    if (line.starts_with(client_mark)) said = partner.answers_to(line.substr(client_mark.size()));
  }
  finish_answers();
  std::ofstream(path) << text;
}

}  // namespace opentmcl::editor
