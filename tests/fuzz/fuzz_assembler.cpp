#include <cstddef>
#include <cstdint>
#include <string>

#include "lang/disassembler.hpp"
#include "lang/listing.hpp"
#include "tests/fuzz/fuzzed_program.hpp"
#include "tests/fuzz/property.hpp"

using namespace opentmcl;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  const ModuleDescription& module = fuzz::module_of(text);
  const lang::AssemblyResult result = fuzz::assemble(text, module);
  bool has_errors = false;
  for (const lang::Diagnostic& diagnostic : result.diagnostics) {
    const std::string& source = result.sources[diagnostic.span.file].text;
    require(std::size_t{diagnostic.span.offset} + diagnostic.span.length <= source.size(), "a problem is in the text");
    require(lang::is_utf8(lang::format(diagnostic, result.sources)), "a message is UTF-8");
    has_errors = has_errors || diagnostic.severity() == lang::Severity::error;
  }
  require(result.program.has_value() == !has_errors, "there is a program exactly if there is no error");
  if (!result.program) return 0;
  lang::listing(*result.program, result.sources);

  const lang::Disassembly disassembly = lang::disassemble(result.program->commands, module);
  require(disassembly.problems.empty(), "what the assembler writes has a form in source");
  require(fuzz::program_of(disassembly.text, module) == result.program->commands, "source and binary are inverse");
  return 0;
}
