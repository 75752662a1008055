// What the tests of the language share: sources as literals in, instructions or diagnostics out.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "lang/assembler.hpp"

namespace opentmcl {

inline std::ostream& operator<<(std::ostream& out, const Command& command) {
  return out << '{' << int{command.opcode} << ", " << int{command.type} << ", " << int{command.motor} << ", "
             << command.value << '}';
}

}  // namespace opentmcl

namespace opentmcl::lang {

/// A diagnostic as the tests compare it.
struct Problem {
  DiagnosticKind kind;
  Position position;
  std::string marked;  ///< the text under the carets

  friend bool operator==(const Problem&, const Problem&) = default;
};

inline std::ostream& operator<<(std::ostream& out, const Problem& problem) {
  return out << name_of(problem.kind) << " at " << problem.position.line << ':' << problem.position.column << " '"
             << problem.marked << '\'';
}

inline std::vector<Problem> problems_of(const std::vector<Diagnostic>& diagnostics, const Sources& sources) {
  std::vector<Problem> problems;
  for (const Diagnostic& diagnostic : diagnostics) {
    const LineIndex lines(sources[diagnostic.span.file].text);
    problems.push_back(
        {diagnostic.kind, lines.position_of(diagnostic.span.offset), std::string(sources.text_of(diagnostic.span))});
  }
  return problems;
}

inline AssemblyResult assemble_text(std::string_view text, const ModuleDescription& module = pd1161,
                                    bool append_stop = false) {
  MemoryFiles files;
  AssemblerOptions options;
  options.module = &module;
  options.append_stop = append_stop;
  options.check_program = false;  // the tests' sources are parts of programs
  return assemble("test.tmc", std::string(text), options, files);
}

/// The instructions of a source that must have no diagnostics.
inline std::vector<Command> commands_of(std::string_view text, const ModuleDescription& module = pd1161) {
  const AssemblyResult result = assemble_text(text, module);
  EXPECT_EQ(format(result.diagnostics, result.sources), "");
  return result.program ? result.program->commands : std::vector<Command>{};
}

inline std::vector<Problem> problems_of(std::string_view text, const ModuleDescription& module = pd1161) {
  const AssemblyResult result = assemble_text(text, module);
  return problems_of(result.diagnostics, result.sources);
}

inline Command command(Opcode opcode, int type = 0, int motor = 0, std::int32_t value = 0) {
  return {static_cast<std::uint8_t>(opcode), static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(motor), value};
}

}  // namespace opentmcl::lang
