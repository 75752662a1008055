#include "lang/include_directive.hpp"

#include <algorithm>
#include <cstddef>

#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

std::string_view without_leading_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\v\f"), text.size()));
  return text;
}

/// File names are written bare, or between quotation marks.
std::string_view without_quotes(std::string_view name) {
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') return name.substr(1, name.size() - 2);
  return name;
}

}  // namespace

std::optional<std::string_view> included_file_name(std::string_view directive) {
  const std::string_view after_sign = without_leading_blanks(directive.substr(1));
  std::size_t length = 0;
  while (length < after_sign.size() && continues_name(after_sign[length])) ++length;
  if (!equal_ignoring_case(after_sign.substr(0, length), "include")) return std::nullopt;
  return without_quotes(without_leading_blanks(after_sign.substr(length)));
}

}  // namespace opentmcl::lang
