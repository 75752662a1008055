#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "editor/lsp/requests.hpp"
#include "lang/diagnostic.hpp"
#include "lang/module_comment.hpp"

namespace opentmcl::editor::lsp {

using lang::Diagnostic;
using lang::DiagnosticKind;
using lang::Severity;

namespace {

/// Nobody reads more of one file, and some editors become slow.
constexpr std::size_t most_diagnostics = 1000;

/// What the server complains about itself, because the assembler is told the module.
constexpr const char* unknown_module = "unknown-module";

bool is_unnecessary(DiagnosticKind kind) {
  return kind == DiagnosticKind::unused_label || kind == DiagnosticKind::unused_constant ||
         kind == DiagnosticKind::unreachable_code;
}

json diagnostic_json(json range, Severity severity, const char* code, const std::string& message) {
  const SeverityCode number = severity == Severity::error ? SeverityCode::error : SeverityCode::warning;
  return {{"range", std::move(range)},
          {"severity", number_of(number)},
          {"code", code},
          {"source", "tmcl"},
          {"message", lang::to_utf8(message)}};
}

json to_json(const View& view, const Diagnostic& diagnostic, const ClientAbilities& client) {
  const bool is_related =
      diagnostic.related && client.related_information && !view.program.sources()[diagnostic.related->file].is_built_in;
  std::string message = diagnostic.message;
  if (!is_related && !diagnostic.note.empty()) message += "\n" + diagnostic.note;
  json result =
      diagnostic_json(view.range(diagnostic.span), diagnostic.severity(), lang::name_of(diagnostic.kind), message);
  if (is_related) {
    json related = {{"location", view.location(*diagnostic.related)}, {"message", lang::to_utf8(diagnostic.note)}};
    result["relatedInformation"] = json::array({std::move(related)});
  }
  if (is_unnecessary(diagnostic.kind)) {
    result["tags"] = json::array({number_of(DiagnosticTagCode::unnecessary)});
  }
  return result;
}

/// The range of a module's name that no module has, in the file that is the program.
std::optional<json> unknown_module_diagnostic(const View& view) {
  if (view.file != 0) return std::nullopt;
  const std::optional<lang::ModuleComment> comment = lang::module_named_in(view.text());
  if (!comment || comment->module != nullptr) return std::nullopt;
  std::string known;
  for (const ModuleDescription& module : modules) known += (known.empty() ? "" : ", ") + std::string(module.argument);
  const auto offset = static_cast<std::size_t>(comment->written.data() - view.text().data());
  return diagnostic_json(range_json(view.index(), offset, comment->written.size()), Severity::error, unknown_module,
                         "there is no module " + lang::in_quotes(comment->written) + "\nknown: " + known);
}

bool overlaps(lang::Span span, std::size_t begin, std::size_t end) {
  return span.offset <= end && begin <= std::size_t{span.offset} + span.length;
}

json edit_action(const std::string& title, const std::string& uri, json edit, json diagnostic, bool is_preferred) {
  json changes = json::object();
  changes[uri] = json::array({std::move(edit)});
  return {{"title", lang::to_utf8(title)},
          {"kind", "quickfix"},
          {"diagnostics", json::array({std::move(diagnostic)})},
          {"isPreferred", is_preferred},
          {"edit", {{"changes", std::move(changes)}}}};
}

/// Adds a comment that switches a warning off for its line; none where the line has a comment already.
std::optional<json> switch_off_action(const View& view, const Diagnostic& diagnostic, json shown) {
  if (diagnostic.severity() != Severity::warning || diagnostic.kind == DiagnosticKind::too_many_warnings) {
    return std::nullopt;
  }
  const lang::SourceLine line = view.line_at(diagnostic.span.offset);
  const std::size_t number = view.index().position_of(diagnostic.span.offset).line;
  const std::size_t end = view.index().start_of(number) + view.index().line(number).size();
  if (line.end_of_line().offset < end || line.token_count() == 0) return std::nullopt;
  const std::string name = lang::name_of(diagnostic.kind);
  return edit_action("switch off " + name + " in this line", view.document.uri(),
                     text_edit(range_json(view.index(), end, 0), "  // no-warning: " + name), std::move(shown), false);
}

}  // namespace

json diagnostics(const View& view, const ClientAbilities& client) {
  json list = json::array();
  if (std::optional<json> unknown = unknown_module_diagnostic(view)) list.push_back(std::move(*unknown));
  std::set<std::tuple<DiagnosticKind, std::uint32_t, std::uint32_t>> seen;
  const std::string& path = view.program.sources()[view.file].name;
  for (const Diagnostic& diagnostic : view.program.result().diagnostics) {
    // A file that is included twice has two numbers, and each of its problems may be there twice.
    const lang::SourceFile& file = view.program.sources()[diagnostic.span.file];
    if (file.is_built_in || file.name != path) continue;
    if (list.size() == most_diagnostics) break;
    const bool is_new = seen.emplace(diagnostic.kind, diagnostic.span.offset, diagnostic.span.length).second;
    if (is_new) list.push_back(to_json(view, diagnostic, client));
  }
  return list;
}

json code_actions(const View& view, std::size_t begin, std::size_t end, const ClientAbilities& client) {
  json actions = json::array();
  for (const Diagnostic& diagnostic : view.program.result().diagnostics) {
    if (diagnostic.span.file != view.file || !overlaps(diagnostic.span, begin, end)) continue;
    json shown = to_json(view, diagnostic, client);
    if (diagnostic.fix && !view.program.sources()[diagnostic.fix->span.file].is_built_in) {
      const lang::Fix& fix = *diagnostic.fix;
      actions.push_back(edit_action(fix.title, view.workspace.uri_of(view.program.sources()[fix.span.file]),
                                    text_edit(view.range(fix.span), lang::to_utf8(fix.replacement)), shown, true));
    }
    if (std::optional<json> action = switch_off_action(view, diagnostic, std::move(shown))) {
      actions.push_back(std::move(*action));
    }
  }
  return actions;
}

}  // namespace opentmcl::editor::lsp
