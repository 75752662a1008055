#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "editor/lsp/requests.hpp"
#include "lang/include_directive.hpp"
#include "lang/name_index.hpp"

namespace opentmcl::editor::lsp {

using lang::NameUse;
using lang::Span;

namespace {

/// More symbols than anybody looks through.
constexpr std::size_t most_symbols = 1000;

bool is_built_in(const View& view, Span span) {
  return view.program.sources()[span.file].is_built_in;
}

/// The `#include` lines of a program that name this file.
json include_lines_of(const View& view, const lang::SourceFile& file) {
  json places = json::array();
  for (lang::FileId id = 0; id < view.program.sources().size(); ++id) {
    const lang::SourceFile& source = view.program.sources()[id];
    if (source.is_built_in || view.program.names().first_id_of(id) != id) continue;
    lang::Lexer lexer(source.text);
    lang::SourceLine line;
    while (!lexer.at_end()) {
      lang::read_source_line(lexer, source.text, line);
      if (line.token_count() == 0 || line.roles[0] != lang::TokenRole::directive) continue;
      const lang::Token& token = line.token(0);
      const std::optional<std::string_view> name = lang::included_file_name(token.text(source.text));
      if (name && *name == file.name) places.push_back(view.location({id, token.offset, token.length}));
    }
  }
  return places;
}

json included_file(const View& view, const lang::Token& directive) {
  const std::optional<std::string_view> name = lang::included_file_name(directive.text(view.text()));
  if (!name) return nullptr;
  const lang::IncludeSearchResult found = view.workspace.search_include(*name, view.document, view.program.module());
  if (found.state != lang::FileContent::State::found || found.is_built_in) return nullptr;
  const json begin = to_json({0, 0});
  const json range = {{"start", begin}, {"end", begin}};
  json place = {{"uri", view.workspace.uri_of({found.path, {}, false})}, {"range", range}};
  return json::array({std::move(place)});
}

std::string utf8(std::string_view text) {
  return lang::to_utf8(text);
}

/// A label or constant with its place, and where it ends: a label before the next one.
struct Outline {
  std::string_view name;
  Span span;
  bool is_label = false;
  std::size_t end = 0;
};

std::vector<Outline> outline_of(const View& view) {
  std::vector<Outline> symbols;
  lang::Lexer lexer(view.text());
  lang::SourceLine line;
  std::optional<std::size_t> open_label;
  while (!lexer.at_end()) {
    lang::read_source_line(lexer, view.text(), line);
    for (std::size_t i = 0; i < line.token_count(); ++i) {
      const bool is_label = line.roles[i] == lang::TokenRole::label;
      if (!is_label && line.roles[i] != lang::TokenRole::constant) continue;
      const lang::Token& token = line.token(i);
      if (is_label) open_label = symbols.size();
      symbols.push_back({token.text(view.text()), {view.file, token.offset, token.length}, is_label, 0});
    }
    if (line.token_count() == 0) continue;
    const std::size_t end = line.token(line.token_count() - 1).end();
    if (!symbols.empty() && !symbols.back().is_label && symbols.back().end == 0) symbols.back().end = end;
    if (open_label) symbols[*open_label].end = end;
  }
  for (Outline& symbol : symbols)
    symbol.end = std::max<std::size_t>(symbol.end, symbol.span.offset + symbol.span.length);
  return symbols;
}

SymbolKindCode code_of(bool is_label) {
  return is_label ? SymbolKindCode::function : SymbolKindCode::constant;
}

char to_lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool contains_ignoring_case(std::string_view text, std::string_view part) {
  return std::search(text.begin(), text.end(), part.begin(), part.end(),
                     [](char a, char b) { return to_lower(a) == to_lower(b); }) != text.end();
}

}  // namespace

json definition(const View& view, std::size_t offset) {
  const lang::SourceLine line = view.line_at(offset);
  const std::size_t index = lang::token_at(line, offset);
  if (index < line.token_count() && line.roles[index] == lang::TokenRole::directive) {
    return included_file(view, line.token(index));
  }
  const NameUse* const use = view.program.names().at(view.file, offset);
  if (use == nullptr) return nullptr;
  json places = json::array();
  for (const NameUse& other : view.program.names().uses_of(use->number)) {
    if (!other.is_definition) continue;
    // Where the user can see that the name comes from: a built-in file cannot be opened.
    if (is_built_in(view, other.span)) return include_lines_of(view, view.program.sources()[other.span.file]);
    places.push_back(view.location(other.span));
  }
  return places.empty() ? json(nullptr) : places;
}

json references(const View& view, std::size_t offset, bool with_definitions) {
  json places = json::array();
  const NameUse* const use = view.program.names().at(view.file, offset);
  if (use == nullptr) return places;
  for (const NameUse& other : view.program.names().uses_of(use->number)) {
    if (is_built_in(view, other.span) || (other.is_definition && !with_definitions)) continue;
    places.push_back(view.location(other.span));
  }
  return places;
}

json document_highlights(const View& view, std::size_t offset) {
  json places = json::array();
  const NameUse* const use = view.program.names().at(view.file, offset);
  if (use == nullptr) return places;
  const lang::FileId here = view.program.names().first_id_of(view.file);
  for (const NameUse& other : view.program.names().uses_of(use->number)) {
    if (other.span.file != here) continue;
    const HighlightKindCode kind = other.is_definition ? HighlightKindCode::write : HighlightKindCode::read;
    places.push_back({{"range", view.range(other.span)}, {"kind", number_of(kind)}});
  }
  return places;
}

json document_symbols(const View& view, const ClientAbilities& client) {
  json symbols = json::array();
  for (const Outline& symbol : outline_of(view)) {
    json item = {{"name", utf8(symbol.name)}, {"kind", number_of(code_of(symbol.is_label))}};
    if (client.nested_symbols) {
      item["range"] = range_json(view.index(), symbol.span.offset, symbol.end - symbol.span.offset);
      item["selectionRange"] = view.range(symbol.span);
    } else {
      item["location"] = view.location(symbol.span);
    }
    symbols.push_back(std::move(item));
  }
  return symbols;
}

json workspace_symbols(Workspace& workspace, const std::string& query) {
  json symbols = json::array();
  std::set<std::tuple<std::string, std::uint32_t>> seen;  // a file can be a part of several programs
  for (Analysis* const program : workspace.programs()) {
    for (const lang::Symbol& symbol : program->symbols().symbols()) {
      const lang::SourceFile& file = program->sources()[symbol.span.file];
      if (file.is_built_in || !contains_ignoring_case(symbol.name, query)) continue;
      const std::string uri = workspace.uri_of(file);
      if (!seen.emplace(uri, symbol.span.offset).second) continue;
      if (symbols.size() == most_symbols) return symbols;
      const json range = range_json(program->text_index(symbol.span.file), symbol.span.offset, symbol.span.length);
      symbols.push_back({{"name", utf8(symbol.name)},
                         {"kind", number_of(code_of(symbol.kind == lang::SymbolKind::label))},
                         {"location", {{"uri", uri}, {"range", range}}}});
    }
  }
  return symbols;
}

}  // namespace opentmcl::editor::lsp
