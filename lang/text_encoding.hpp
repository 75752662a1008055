// Files that are given as sources by mistake.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace opentmcl::lang {

/// Whether a text is UTF-16, by its byte order mark or by the zeros of its first two characters.
bool is_utf16(std::string_view text);

/// The first character that no text has: a control character other than blanks and line ends.
std::optional<std::size_t> find_control_character(std::string_view text);

}  // namespace opentmcl::lang
