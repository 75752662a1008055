#include "lang/renaming.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "editor/lsp/requests.hpp"
#include "lang/name_index.hpp"

namespace opentmcl::editor::lsp {

using lang::NameUse;

Answer prepare_rename(const View& view, std::size_t offset) {
  const NameUse* const use = view.program.names().at(view.file, offset);
  if (use == nullptr) return json(nullptr);
  const std::string_view name = view.program.names().name(use->number);
  if (auto refusal = lang::refusal_to_rename(name, view.program.symbols(), view.program.sources())) {
    return ResponseError{ErrorCode::request_failed, *refusal};
  }
  const std::string written = lang::to_utf8(view.program.sources().text_of(use->span));
  return json{{"range", view.range({view.file, use->span.offset, use->span.length})}, {"placeholder", written}};
}

Answer rename(const std::vector<View>& views, std::size_t offset, const std::string& new_name) {
  std::map<std::string, json> changes;
  std::set<std::tuple<std::string, std::uint32_t>> seen;  // a file can be a part of several programs
  for (const View& view : views) {
    const lang::NameIndex& names = view.program.names();
    const NameUse* const use = names.at(view.file, offset);
    if (use == nullptr) return ResponseError{ErrorCode::request_failed, "there is no label or constant here"};
    const std::string_view name = names.name(use->number);
    std::optional<std::string> refusal = lang::refusal_to_rename(name, view.program.symbols(), view.program.sources());
    if (!refusal) refusal = lang::refusal_of_new_name(name, new_name, names);
    if (refusal) return ResponseError{ErrorCode::request_failed, *refusal};
    for (const NameUse& other : names.uses_of(use->number)) {
      const std::string uri = view.workspace.uri_of(view.program.sources()[other.span.file]);
      if (!seen.emplace(uri, other.span.offset).second) continue;
      json& edits = changes.emplace(uri, json::array()).first->second;
      edits.push_back(text_edit(view.range(other.span), new_name));
    }
  }
  return json{{"changes", changes}};
}

}  // namespace opentmcl::editor::lsp
