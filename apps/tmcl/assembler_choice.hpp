#pragma once

#include <string>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "lang/assembler.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace opentmcl::app {

/// What a user says about how sources are assembled, in every command that does so.
struct AssemblerChoice {
  std::vector<std::string> include_folders;
  std::vector<std::string> switched_off;  ///< names of warnings, or "all"
  bool warnings_as_errors = false;
};

/// -I, --no-warning, which takes the names of warnings only, and --warnings-as-errors.
void add_assembler_options(CLI::App& command, AssemblerChoice& choice);

lang::AssemblerOptions assembler_options(const AssemblerChoice& choice, const ModuleDescription& module);

}  // namespace opentmcl::app
