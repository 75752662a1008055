#pragma once

#include <string>
#include <vector>

#include "client/error.hpp"
#include "firmware/spec/modules.hpp"
#include "lang/assembler.hpp"

namespace opentmcl::app {

/// The whole file, as bytes. Error: bad_file.
client::Result<std::string> read_file(const std::string& path);

/// Errors: input_output.
client::Result<void> write_file(const std::string& path, const std::string& content);

/// Assembles a file and prints errors and warnings on stderr. Error: bad_file.
client::Result<lang::AssemblyResult> assemble_file(const std::string& path, const lang::AssemblerOptions& options);

}  // namespace opentmcl::app
