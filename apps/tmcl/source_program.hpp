#pragma once

#include <string>

#include "client/error.hpp"
#include "firmware/spec/modules.hpp"
#include "lang/assembler.hpp"

namespace opentmcl::app {

/// Instead of a file's path: what comes on standard input.
inline constexpr const char* standard_input = "-";

/// The whole file or standard input, as bytes. Error: bad_file.
client::Result<std::string> read_file(const std::string& path);

/// The text of a source, a file or standard input, which is not larger than any source may be. Error: bad_file.
client::Result<std::string> read_source(const std::string& path);

/// The module a source names in a comment, or nullptr. Error: bad_file, there is no such module.
client::Result<const ModuleDescription*> module_named_by(const std::string& path, const std::string& text);

/// The module a source is assembled for: the one called `argument`, else the one its comment names, else the PD-1161
/// (docs/decisions/0074-module-of-a-source.md). Errors: usage, bad_file.
client::Result<const ModuleDescription*> module_of_source(const std::string& path, const std::string& text,
                                                          const std::string& argument);

/// "my.tmc: 2 errors, 1 warning"; empty if there are none.
std::string summary_of(const std::string& path, const lang::AssemblyResult& result);

/// Prints errors, warnings and how many they are on stderr; with colours on a terminal.
void print_diagnostics(const std::string& path, const lang::AssemblyResult& result);

/// Assembles a source and prints errors and warnings on stderr. Error: bad_file.
client::Result<lang::AssemblyResult> assemble_text(const std::string& path, std::string text,
                                                   const lang::AssemblerOptions& options);
/// The same of a file.
client::Result<lang::AssemblyResult> assemble_file(const std::string& path, const lang::AssemblerOptions& options);

}  // namespace opentmcl::app
