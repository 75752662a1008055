#include "lang/completion.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "editor/lsp/requests.hpp"
#include "lang/include_files.hpp"

namespace opentmcl::editor::lsp {
namespace {

/// So many entries of a folder are looked at for files that can be included.
constexpr std::size_t most_files = 10000;

CompletionItemKindCode code_of(lang::CompletionKind kind) {
  switch (kind) {
    case lang::CompletionKind::mnemonic:
    case lang::CompletionKind::directive:
      return CompletionItemKindCode::keyword;
    case lang::CompletionKind::word:
      return CompletionItemKindCode::enum_member;
    case lang::CompletionKind::number:
      return CompletionItemKindCode::value;
    case lang::CompletionKind::constant:
      return CompletionItemKindCode::constant;
    case lang::CompletionKind::label:
      return CompletionItemKindCode::reference;
    case lang::CompletionKind::function:
      return CompletionItemKindCode::function;
  }
  return CompletionItemKindCode::keyword;
}

/// Files beside the document, and the built-in ones.
json file_items(const View& view, const json& range) {
  json items = json::array();
  const auto add = [&](const std::string& name) {
    items.push_back(
        {{"label", name}, {"kind", number_of(CompletionItemKindCode::file)}, {"textEdit", text_edit(range, name)}});
  };
  add(lang::parameter_file_name);
  add(lang::interrupt_file_name);
  const std::filesystem::path path(view.document.path());
  if (!path.is_absolute()) return items;
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(path.parent_path(), error);
  for (std::size_t i = 0; !error && entry != std::filesystem::directory_iterator() && i < most_files; ++i) {
    const std::string extension = entry->path().extension().string();
    std::error_code unknown;
    const bool is_source = extension == ".tmc" || extension == ".tmcl" || extension == ".inc";
    if (is_source && entry->path() != path && entry->is_regular_file(unknown)) {
      names.push_back(entry->path().filename().string());
    }
    entry.increment(error);
  }
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) add(name);
  return items;
}

}  // namespace

json completion(const View& view, std::size_t offset, const ClientAbilities& client) {
  const lang::CursorPlace place = lang::place_of_cursor(view.text(), offset);
  const std::size_t start = place.start;
  const json range = view.range({view.file, place.start, static_cast<std::uint32_t>(offset - start)});
  if (place.kind == lang::CursorPlace::Kind::file_name) {
    return {{"isIncomplete", false}, {"items", file_items(view, range)}};
  }
  const std::string_view written = view.text().substr(start, offset - start);
  const lang::CompletionList candidates =
      lang::completions(place, written, view.file, offset, view.program.symbols(), view.program.module());
  json items = json::array();
  for (const lang::Completion& candidate : candidates.items) {
    const lang::Explanation& explanation = candidate.explanation;
    json item = {{"label", candidate.label},
                 {"kind", number_of(code_of(candidate.kind))},
                 {"filterText", candidate.label},
                 {"textEdit", text_edit(range, candidate.text)}};
    if (!explanation.title.empty()) {
      item["detail"] = lang::to_utf8(explanation.title);
      item["documentation"] = markup(explanation, client);
    }
    items.push_back(std::move(item));
  }
  return {{"isIncomplete", !candidates.is_complete}, {"items", std::move(items)}};
}

}  // namespace opentmcl::editor::lsp
