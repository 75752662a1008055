#include "lang/symbol_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <vector>

#include "lang/instruction_table.hpp"

namespace opentmcl::lang {
namespace {

/// The shortest text that reads back as the same number.
std::string text_of(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return error == std::errc() ? std::string(text, end) : std::to_string(value);
}

class SymbolFile {
 public:
  explicit SymbolFile(const Sources& sources) : sources_(&sources) {}

  void add(const Symbol& symbol, const char* what) {
    const SourceFile& file = (*sources_)[symbol.span.file];
    auto lines = lines_.find(symbol.span.file);
    if (lines == lines_.end()) lines = lines_.emplace(symbol.span.file, LineIndex(file.text)).first;
    text_ += std::string(symbol.name) + " = " + text_of(symbol.value) + " // " + what + ", " + to_utf8(file.name) +
             ":" + std::to_string(lines->second.position_of(symbol.span.offset).line) + "\n";
  }

  void add_heading(const std::string& heading) { text_ += "// " + heading + "\n"; }

  std::string text() const { return text_; }

 private:
  const Sources* sources_;
  std::map<FileId, LineIndex> lines_;
  std::string text_;
};

}  // namespace

std::string symbol_file(const AssemblyResult& result, const ModuleDescription& module) {
  std::vector<const Symbol*> labels;
  std::vector<const Symbol*> constants;
  for (const Symbol& symbol : result.symbols.symbols()) {
    if (result.sources[symbol.span.file].is_built_in) continue;
    (symbol.kind == SymbolKind::label ? labels : constants).push_back(&symbol);
  }
  std::stable_sort(labels.begin(), labels.end(),
                   [](const Symbol* left, const Symbol* right) { return left->value < right->value; });
  SymbolFile file(result.sources);
  file.add_heading("Labels and constants of " + to_utf8(result.sources[0].name) + " for the " + describe(module));
  for (const Symbol* label : labels) file.add(*label, "label");
  for (const Symbol* constant : constants) file.add(*constant, "constant");
  return file.text();
}

}  // namespace opentmcl::lang
