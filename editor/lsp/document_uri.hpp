#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace opentmcl::editor::lsp {

/// The path of a file: URI, as it is compared with other paths; none for URIs of another kind.
std::optional<std::string> path_of_uri(std::string_view uri);

/// The file: URI of an absolute path.
std::string uri_of_path(std::string_view path);

}  // namespace opentmcl::editor::lsp
