#pragma once

#include <string>

#include "client/error.hpp"

namespace opentmcl::app {

/// Gives a file a new content in one step: whoever reads it sees the old content or the new one, also when the program
/// or the machine stops in between. Its permissions stay; a symbolic link stays one. Error: input_output, with the old
/// content still there.
client::Result<void> replace_file(const std::string& path, const std::string& content);

}  // namespace opentmcl::app
