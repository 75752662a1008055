// The assembler: TMCL source to instructions, as the TMCL-IDE's, but for one module, and with all errors in one run.
//
// Where the language is not written down anywhere, this one
//  * lets labels be used anywhere, constants only after their definition;
//  * lets a constant be defined again with the same value, so that two files can include the same third one;
//  * takes one surplus operand if it is 0, as old sources have it (`GAP 1, 0, 0`);
//  * refuses what an instruction cannot hold, and warns of what the module will answer with an error.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/diagnostic.hpp"
#include "lang/file_provider.hpp"
#include "lang/program.hpp"
#include "lang/source.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

struct AssemblerOptions {
  const ModuleDescription* module = &pd1161;
  bool append_stop = true;     ///< unless the last instruction is STOP
  bool check_capacity = true;  ///< an error if the program does not fit the module
  /// Folders, after the including file's own and before the built-in files.
  std::vector<std::string> include_path = {};
  /// Warnings nobody wants to see. A source can switch off more of them: lang/switched_off.hpp.
  DiagnosticKinds switched_off = {};
  bool warnings_as_errors = false;
  /// Whether the whole program is looked at, too: lang/program_check.hpp.
  bool check_program = true;
};

struct AssemblyResult {
  std::optional<Program> program;  ///< none if there is an error
  std::vector<Diagnostic> diagnostics;
  Sources sources;      ///< what all spans refer to; file 0 is the one given
  SymbolTable symbols;  ///< constants and labels, also when there is an error; their names are texts of `sources`
};

/// `file_name` is for messages and for finding included files; the text of the file is `text`.
AssemblyResult assemble(std::string_view file_name, std::string text, const AssemblerOptions& options,
                        FileProvider& files);

struct InstructionResult {
  std::optional<Command> command;
  std::vector<Diagnostic> diagnostics;
  Sources sources;
};

/// One instruction in mnemonic form, "MVP ABS, 0, 1000", as typed on a command line. Operands can be expressions and
/// use the constants of the built-in files. `text` is at most `maximum_text_size` long.
InstructionResult parse_instruction(std::string_view text, const ModuleDescription& module);

}  // namespace opentmcl::lang
