// Conversations with the language server as files: conversations/README.md.
#pragma once

#include <string>
#include <vector>

namespace opentmcl::editor::lsp {

/// Names of the files in a folder that end with ".conversation", in alphabetical order.
std::vector<std::string> conversations_in(const std::string& folder);

/// Holds the conversation; reports to GoogleTest what the server says differently from the file.
void replay(const std::string& path);

/// Writes what the server says now into the file.
void record(const std::string& path);

}  // namespace opentmcl::editor::lsp
