#include "lang/formatter.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "editor/lsp/requests.hpp"

namespace opentmcl::editor::lsp {
namespace {

/// The edit of one line and its end.
json to_json(const TextIndex& index, const lang::LineEdit& edit) {
  const std::size_t line = edit.line - 1;
  const bool is_last = line + 1 >= index.line_count();
  const Position end = is_last ? index.position_of(index.text().size()) : Position{line + 1, 0};
  return text_edit({{"start", lsp::to_json({line, 0})}, {"end", lsp::to_json(end)}}, edit.text);
}

}  // namespace

json formatting(const Document& document) {
  json edits = json::array();
  for (const lang::LineEdit& edit : lang::formatting_of(document.text()).edits) {
    edits.push_back(to_json(document.index(), edit));
  }
  return edits;
}

json range_formatting(const Document& document, std::size_t begin, std::size_t end) {
  const std::size_t first = document.index().position_of(begin).line;
  const Position last = document.index().position_of(end);
  // A selection of whole lines ends at the beginning of the next one.
  const std::size_t behind = last.character == 0 && last.line > first ? last.line : last.line + 1;
  json edits = json::array();
  for (const lang::LineEdit& edit : lang::formatting_of(document.text()).edits) {
    const std::size_t line = edit.line - 1;
    if (line >= first && line < behind) edits.push_back(to_json(document.index(), edit));
  }
  return edits;
}

}  // namespace opentmcl::editor::lsp
