#include "tests/conformance/statement_file.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace opentmcl::conformance {

namespace {

constexpr std::array<std::string_view, 8> known_keys = {"id",   "section",  "says",    "module",
                                                        "port", "decision", "program", "steps"};

[[noreturn]] void fail(const std::string& path, const toml::node& node, const std::string& what) {
  throw std::runtime_error(path + ':' + std::to_string(node.source().begin.line) + ": " + what);
}

std::optional<hal::PortKind> port_kind(std::string_view name) {
  if (name == "usb") return hal::PortKind::usb;
  if (name == "rs485") return hal::PortKind::rs485;
  if (name == "rs232") return hal::PortKind::rs232;
  return std::nullopt;
}

Statement parse_statement(const toml::table& table, const std::string& path) {
  for (const auto& [key, value] : table) {
    if (std::find(known_keys.begin(), known_keys.end(), key.str()) == known_keys.end()) {
      fail(path, value, "a statement has no \"" + std::string(key.str()) + '"');
    }
    if (!value.is_string()) fail(path, value, "expected a string");
  }
  const auto text = [&table](std::string_view key, std::string_view otherwise = {}) {
    return std::string(table[key].value_or(otherwise));
  };
  for (const std::string_view key : {"id", "section", "says", "steps"}) {
    if (text(key).empty()) fail(path, table, "the statement lacks \"" + std::string(key) + '"');
  }
  const std::optional<hal::PortKind> port = port_kind(text("port", "usb"));
  if (!port) fail(path, table, "unknown port");
  return {text("id"), text("section"),  text("says"),    modules_named(text("module", "both")),
          *port,      text("decision"), text("program"), text("steps")};
}

}  // namespace

Statements read_statements(const std::string& path) {
  try {
    const toml::table file = toml::parse_file(path);
    const toml::array* const rows = file["statement"].as_array();
    if (rows == nullptr || file.size() != 1)
      throw std::runtime_error(path + ": expected [[statement]] and nothing else");
    Statements statements;
    for (const toml::node& row : *rows) {
      const toml::table* const table = row.as_table();
      if (table == nullptr) fail(path, row, "expected a table");
      statements.push_back(parse_statement(*table, path));
    }
    return statements;
  } catch (const toml::parse_error& error) {
    std::ostringstream message;
    message << path << ':' << error.source().begin.line << ": " << error.description();
    throw std::runtime_error(message.str());
  }
}

}  // namespace opentmcl::conformance
