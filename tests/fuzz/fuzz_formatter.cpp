#include <cstddef>
#include <cstdint>
#include <string>

#include "lang/formatter.hpp"
#include "lang/source.hpp"
#include "tests/fuzz/fuzzed_program.hpp"
#include "tests/fuzz/property.hpp"

using namespace opentmcl;
using fuzz::require;

namespace {

std::string applied(std::string_view source, const std::vector<lang::LineEdit>& edits) {
  const lang::LineIndex index(source);
  std::string text;
  auto edit = edits.begin();
  for (std::size_t line = 1; line <= index.line_count(); ++line) {
    const std::size_t start = index.start_of(line);
    const std::size_t end = line < index.line_count() ? index.start_of(line + 1) : source.size();
    const bool is_edited = edit != edits.end() && edit->line == line;
    text += is_edited ? edit++->text : std::string(source.substr(start, end - start));
  }
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  const ModuleDescription& module = fuzz::module_of(text);
  const lang::Formatting formatting = lang::formatting_of(text);
  require(lang::format_source(formatting.text) == formatting.text, "formatting twice is formatting once");
  require(applied(text, formatting.edits) == formatting.text, "the edits make the text");
  require(lang::is_utf8(formatting.text), "the text is UTF-8");

  // Included texts are not formatted with the source, so that what is compared includes the same.
  const auto program = [&](std::string_view source) -> std::optional<std::vector<Command>> {
    lang::MemoryFiles no_files;
    lang::AssemblerOptions options;
    options.module = &module;
    lang::AssemblyResult result = lang::assemble("fuzz.tmc", std::string(source), options, no_files);
    if (!result.program) return std::nullopt;
    return std::move(result.program->commands);
  };
  require(program(text) == program(formatting.text), "the program stays the same");
  return 0;
}
