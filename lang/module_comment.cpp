#include "lang/module_comment.hpp"

#include <algorithm>
#include <cstddef>

#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

constexpr std::string_view blanks = " \t\v\f";
constexpr std::string_view line_ends = "\r\n";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::string_view key = "module";

std::string_view without_leading_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text;
}

/// What follows the signs that begin a comment; none if the line is no comment.
std::optional<std::string_view> comment_of(std::string_view line) {
  if (line.substr(0, 1) == ";") return line.substr(1);
  if (line.substr(0, 2) == "//") return line.substr(2);
  return std::nullopt;
}

std::optional<ModuleComment> module_in_comment(std::string_view comment) {
  comment = without_leading_blanks(comment);
  if (!equal_ignoring_case(comment.substr(0, key.size()), key)) return std::nullopt;
  comment = without_leading_blanks(comment.substr(key.size()));
  if (comment.substr(0, 1) != ":") return std::nullopt;
  comment = without_leading_blanks(comment.substr(1));
  const std::string_view name = comment.substr(0, comment.find_first_of(blanks));
  return ModuleComment{name, find_module(name)};
}

}  // namespace

const ModuleDescription* find_module(std::string_view name) {
  for (const ModuleDescription& module : modules) {
    if (equal_ignoring_case(name, module.argument) || equal_ignoring_case(name, module.name)) return &module;
  }
  return nullptr;
}

std::optional<ModuleComment> module_named_in(std::string_view text) {
  if (text.substr(0, byte_order_mark.size()) == byte_order_mark) text.remove_prefix(byte_order_mark.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(line_ends), text.size());
    const std::string_view line = without_leading_blanks(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    const std::optional<std::string_view> comment = comment_of(line);
    if (!comment) return std::nullopt;
    if (const std::optional<ModuleComment> found = module_in_comment(*comment)) return found;
  }
  return std::nullopt;
}

}  // namespace opentmcl::lang
