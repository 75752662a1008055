#pragma once

#include <optional>
#include <string_view>

namespace opentmcl::lang {

/// The file name of `#include NAME`, bare or without its quotation marks, as a part of `directive`, which is the text
/// of a TokenKind::directive. Empty if it is missing; none if the directive is another one.
std::optional<std::string_view> included_file_name(std::string_view directive);

}  // namespace opentmcl::lang
