#include "editor/lsp/language_server.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "lang/module_comment.hpp"

namespace opentmcl::editor::lsp {
namespace {

constexpr const char* not_open = "the document is not open";

ResponseError invalid(std::string message) {
  return {ErrorCode::invalid_parameters, std::move(message)};
}

bool contains(const json& list, const char* word) {
  return list.is_array() && std::find(list.begin(), list.end(), word) != list.end();
}

bool is_true(const json& value) {
  return value.is_boolean() && value.get<bool>();
}

/// A text that is too large for the assembler is empty in the program.
std::size_t offset_in(const View& view, Position position) {
  return std::min(view.document.index().offset_of(position), view.text().size());
}

/// Responses to requests of the server have neither.
bool is_response(const json& message) {
  return message.is_object() && !message.contains("method") &&
         (message.contains("result") || message.contains("error"));
}

}  // namespace

const LanguageServer::Request LanguageServer::requests[] = {
    {"initialize", &LanguageServer::initialize},
    {"shutdown", &LanguageServer::shut_down},
    {"textDocument/hover", &LanguageServer::hover},
    {"textDocument/signatureHelp", &LanguageServer::signature_help},
    {"textDocument/inlayHint", &LanguageServer::inlay_hints},
    {"textDocument/completion", &LanguageServer::completion},
    {"textDocument/definition", &LanguageServer::definition},
    {"textDocument/references", &LanguageServer::references},
    {"textDocument/documentHighlight", &LanguageServer::document_highlights},
    {"textDocument/documentSymbol", &LanguageServer::document_symbols},
    {"workspace/symbol", &LanguageServer::workspace_symbols},
    {"textDocument/prepareRename", &LanguageServer::prepare_rename},
    {"textDocument/rename", &LanguageServer::rename},
    {"textDocument/semanticTokens/full", &LanguageServer::semantic_tokens},
    {"textDocument/semanticTokens/range", &LanguageServer::semantic_tokens_of_range},
    {"textDocument/foldingRange", &LanguageServer::folding_ranges},
    {"textDocument/formatting", &LanguageServer::formatting},
    {"textDocument/rangeFormatting", &LanguageServer::range_formatting},
    {"textDocument/codeAction", &LanguageServer::code_actions},
};

const LanguageServer::Notification LanguageServer::notifications[] = {
    {"initialized", &LanguageServer::initialized},
    {"textDocument/didOpen", &LanguageServer::open},
    {"textDocument/didChange", &LanguageServer::change},
    {"textDocument/didClose", &LanguageServer::close},
    {"textDocument/didSave", &LanguageServer::save},
    {"workspace/didChangeConfiguration", &LanguageServer::change_settings},
    {"workspace/didChangeWatchedFiles", &LanguageServer::change_files},
};

LanguageServer::LanguageServer(Send send, lang::FileProvider& disk) : send_(std::move(send)), disk_(&disk) {}

// ---- messages

void LanguageServer::take(const json& message) {
  if (exit_code_ || is_response(message)) return;
  const std::optional<std::string> method = text_of(member(message, "method"));
  const json& id = member(message, "id");
  const bool has_id = id.is_string() || id.is_number_integer();
  if (!method || (!id.is_null() && !has_id)) {
    respond(has_id ? id : json(nullptr), ResponseError{ErrorCode::invalid_request, "expected a request with a method"});
  } else if (has_id) {
    take_request(id, *method, member(message, "params"));
  } else {
    take_notification(*method, member(message, "params"));
  }
}

void LanguageServer::refuse_message(const std::string& why) {
  respond(nullptr, ResponseError{ErrorCode::parse_error, why});
}

void LanguageServer::refuse_cancelled(const json& request) {
  respond(member(request, "id"), ResponseError{ErrorCode::request_cancelled, "cancelled"});
}

void LanguageServer::take_request(const json& id, const std::string& method, const json& parameters) {
  const bool is_initialize = method == "initialize";
  if (stage_ == Stage::created && !is_initialize) {
    return respond(id, ResponseError{ErrorCode::server_not_initialized, "expected initialize first, not " + method});
  }
  if (stage_ == Stage::shut_down || (stage_ != Stage::created && is_initialize)) {
    const char* const why = is_initialize ? "initialize came already" : "the server is shut down";
    return respond(id, ResponseError{ErrorCode::invalid_request, why});
  }
  const auto known = std::find_if(std::begin(requests), std::end(requests),
                                  [&](const Request& request) { return request.method == method; });
  if (known == std::end(requests)) {
    return respond(id, ResponseError{ErrorCode::method_not_found, "there is no method " + method});
  }
  respond(id, (this->*known->handle)(parameters));
}

void LanguageServer::take_notification(const std::string& method, const json& parameters) {
  if (method == "exit") return exit(parameters);
  if (stage_ != Stage::initializing && stage_ != Stage::running) return;
  for (const Notification& notification : notifications) {
    if (notification.method == method) (this->*notification.handle)(parameters);
  }
}

void LanguageServer::respond(const json& id, const Answer& answer) {
  json message = {{"jsonrpc", "2.0"}, {"id", id}};
  if (const auto* const error = std::get_if<ResponseError>(&answer)) {
    message["error"] = {{"code", number_of(error->code)}, {"message", error->message}};
  } else {
    message["result"] = std::get<json>(answer);
  }
  send_(message);
}

void LanguageServer::notify(const char* method, json parameters) {
  send_({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(parameters)}});
}

// ---- the server itself

Answer LanguageServer::initialize(const json& parameters) {
  const json& abilities = member(parameters, "capabilities");
  const json& document = member(abilities, "textDocument");
  client_.markdown = contains(member(member(document, "hover"), "contentFormat"), "markdown");
  client_.related_information = is_true(member(document, "publishDiagnostics", "relatedInformation"));
  client_.nested_symbols = is_true(member(document, "documentSymbol", "hierarchicalDocumentSymbolSupport"));
  client_.watches_files =
      is_true(member(member(abilities, "workspace"), "didChangeWatchedFiles", "dynamicRegistration"));
  if (contains(member(abilities, "general", "positionEncodings"), "utf-8")) encoding_ = PositionEncoding::utf8;
  workspace_.emplace(*disk_, encoding_);
  stage_ = Stage::initializing;
  take_settings(member(parameters, "initializationOptions"));
  return json{{"capabilities", capabilities()}, {"serverInfo", {{"name", "tmcl lsp"}}}};
}

json LanguageServer::capabilities() const {
  const json sync = {{"openClose", true}, {"change", number_of(SyncKindCode::incremental)}, {"save", true}};
  return {
      {"positionEncoding", encoding_ == PositionEncoding::utf8 ? "utf-8" : "utf-16"},
      {"textDocumentSync", sync},
      {"hoverProvider", true},
      {"completionProvider", {{"triggerCharacters", {" ", ",", "#"}}}},
      {"signatureHelpProvider", {{"triggerCharacters", {" ", ","}}}},
      {"definitionProvider", true},
      {"referencesProvider", true},
      {"documentHighlightProvider", true},
      {"documentSymbolProvider", true},
      {"workspaceSymbolProvider", true},
      {"codeActionProvider", {{"codeActionKinds", json::array({"quickfix"})}}},
      {"documentFormattingProvider", true},
      {"documentRangeFormattingProvider", true},
      {"renameProvider", {{"prepareProvider", true}}},
      {"foldingRangeProvider", true},
      {"inlayHintProvider", true},
      {"semanticTokensProvider", {{"legend", semantic_tokens_legend()}, {"range", true}, {"full", true}}},
  };
}

void LanguageServer::initialized(const json& /*parameters*/) {
  stage_ = Stage::running;
  if (!client_.watches_files) return;
  // Included files that are not open can change, too.
  const json watchers = json::array({{{"globPattern", "**/*.{tmc,tmcl,inc,TMC,INC}"}}});
  const json registration = {
      {"id", "files"}, {"method", "workspace/didChangeWatchedFiles"}, {"registerOptions", {{"watchers", watchers}}}};
  send_({{"jsonrpc", "2.0"},
         {"id", "register-files"},
         {"method", "client/registerCapability"},
         {"params", {{"registrations", json::array({registration})}}}});
}

Answer LanguageServer::shut_down(const json& /*parameters*/) {
  stage_ = Stage::shut_down;
  return json(nullptr);
}

void LanguageServer::exit(const json& /*parameters*/) {
  exit_code_ = stage_ == Stage::shut_down ? 0 : 1;
}

void LanguageServer::take_settings(const json& settings) {
  Settings chosen = workspace_->settings();
  if (const auto name = text_of(member(settings, "module"))) {
    const ModuleDescription* const module = lang::find_module(*name);
    if (module != nullptr) {
      chosen.module = module;
    } else {
      notify("window/showMessage", {{"type", 1}, {"message", "there is no module '" + *name + "'"}});
    }
  }
  const json& folders = member(settings, "includePath");
  if (folders.is_array()) {
    chosen.include_path.clear();
    for (const json& folder : folders) {
      if (const auto path = text_of(folder)) chosen.include_path.push_back(*path);
    }
  }
  workspace_->set(std::move(chosen));
  has_changed_ = true;
}

// ---- documents

void LanguageServer::open(const json& parameters) {
  const json& document = member(parameters, "textDocument");
  const auto uri = text_of(member(document, "uri"));
  const auto text = text_of(member(document, "text"));
  if (!uri || !text) return;
  const json& version = member(document, "version");
  workspace_->open(*uri, *text, version.is_number_integer() ? version.get<std::int64_t>() : 0);
  has_changed_ = true;
}

void LanguageServer::change(const json& parameters) {
  const auto uri = text_of(member(parameters, "textDocument", "uri"));
  Document* const document = uri ? workspace_->find(*uri) : nullptr;
  const json& changes = member(parameters, "contentChanges");
  if (document == nullptr || !changes.is_array()) return;
  for (const json& change : changes) {
    const auto text = text_of(member(change, "text"));
    if (!text) continue;
    const std::optional<Range> range = range_of(member(change, "range"));
    if (range) {
      const std::size_t begin = document->index().offset_of(range->start);
      const std::size_t end = std::max(begin, document->index().offset_of(range->end));
      document->set_text(std::string(document->text()).replace(begin, end - begin, *text));
    } else {
      document->set_text(*text);
    }
  }
  const json& version = member(parameters, "textDocument", "version");
  if (version.is_number_integer()) document->set_version(version.get<std::int64_t>());
  workspace_->note_change(*document);
  has_changed_ = true;
}

void LanguageServer::close(const json& parameters) {
  if (const auto uri = text_of(member(parameters, "textDocument", "uri"))) workspace_->close(*uri);
  has_changed_ = true;
}

void LanguageServer::save(const json& /*parameters*/) {
  workspace_->note_change_of_files();
  has_changed_ = true;
}

void LanguageServer::change_settings(const json& parameters) {
  const json& settings = member(parameters, "settings");
  const json& section = member(settings, "tmcl");
  take_settings(section.is_object() ? section : settings);
}

void LanguageServer::change_files(const json& /*parameters*/) {
  workspace_->note_change_of_files();
  has_changed_ = true;
}

void LanguageServer::publish() {
  if (!has_changed_ || stage_ == Stage::shut_down || !workspace_) return;
  has_changed_ = false;
  std::map<std::string, json> lists;
  for (const Document* const document : workspace_->documents()) lists.emplace(document->uri(), json::array());
  for (Analysis* const program : workspace_->programs()) {
    const Document* const main = workspace_->find(workspace_->uri_of(program->sources()[0]));
    std::set<std::string> seen;  // files that are included twice
    for (lang::FileId file = 0; file < program->sources().size(); ++file) {
      const lang::SourceFile& source = program->sources()[file];
      if (source.is_built_in || main == nullptr || !seen.insert(source.name).second) continue;
      json& list = lists.emplace(workspace_->uri_of(source), json::array()).first->second;
      const bool is_shared = !list.empty();
      for (json& item : diagnostics({*workspace_, *main, *program, file}, client_)) {
        // What several programs say about a file is said once.
        if (!is_shared || std::find(list.begin(), list.end(), item) == list.end()) list.push_back(std::move(item));
      }
    }
  }
  for (auto& [uri, list] : lists) publish_file(uri, std::move(list));
  for (auto published = published_.begin(); published != published_.end();) {
    const bool is_gone = lists.count(published->first) == 0;
    if (is_gone && !published->second.list.empty()) {
      notify("textDocument/publishDiagnostics", {{"uri", published->first}, {"diagnostics", json::array()}});
    }
    published = is_gone ? published_.erase(published) : std::next(published);
  }
}

void LanguageServer::publish_file(const std::string& uri, json list) {
  const Document* const document = workspace_->find(uri);
  const std::optional<std::int64_t> version =
      document == nullptr ? std::nullopt : std::optional<std::int64_t>(document->version());
  Published& last = published_[uri];
  if (last.list == list && last.version == version) return;
  json parameters = {{"uri", uri}, {"diagnostics", list}};
  if (version) parameters["version"] = *version;
  last = {std::move(list), version};
  notify("textDocument/publishDiagnostics", std::move(parameters));
}

// ---- requests about documents

std::variant<std::vector<View>, ResponseError> LanguageServer::views_of(const json& parameters) {
  const auto uri = text_of(member(parameters, "textDocument", "uri"));
  if (!uri) return invalid("expected params.textDocument.uri");
  const Document* const document = workspace_->find(*uri);
  if (document == nullptr) return invalid(not_open);
  std::vector<View> views;
  for (Analysis* const program : workspace_->programs_of(*document)) {
    views.push_back({*workspace_, *document, *program, program->find(document->path()).value_or(0)});
  }
  return views;
}

Answer LanguageServer::at_document(const json& parameters, const std::function<Answer(const View&)>& look) {
  const auto views = views_of(parameters);
  if (const auto* const error = std::get_if<ResponseError>(&views)) return *error;
  return look(std::get<std::vector<View>>(views).front());
}

Answer LanguageServer::at_place(const json& parameters,
                                const std::function<Answer(const View&, std::size_t offset)>& look) {
  const std::optional<Position> position = position_of(member(parameters, "position"));
  if (!position) return invalid("expected params.position");
  return at_document(parameters, [&](const View& view) { return look(view, offset_in(view, *position)); });
}

Answer LanguageServer::in_range(const json& parameters,
                                const std::function<Answer(const View&, std::size_t begin, std::size_t end)>& look) {
  const std::optional<Range> range = range_of(member(parameters, "range"));
  if (!range) return invalid("expected params.range");
  return at_document(parameters, [&](const View& view) {
    return look(view, offset_in(view, range->start), offset_in(view, range->end));
  });
}

Answer LanguageServer::hover(const json& parameters) {
  return at_place(parameters, [&](const View& view, std::size_t offset) { return lsp::hover(view, offset, client_); });
}

Answer LanguageServer::signature_help(const json& parameters) {
  return at_place(parameters, [](const View& view, std::size_t offset) { return lsp::signature_help(view, offset); });
}

Answer LanguageServer::inlay_hints(const json& parameters) {
  return in_range(parameters, [](const View& view, std::size_t begin, std::size_t end) {
    return lsp::inlay_hints(view, begin, end);
  });
}

Answer LanguageServer::completion(const json& parameters) {
  return at_place(parameters,
                  [&](const View& view, std::size_t offset) { return lsp::completion(view, offset, client_); });
}

Answer LanguageServer::definition(const json& parameters) {
  return at_place(parameters, [](const View& view, std::size_t offset) { return lsp::definition(view, offset); });
}

Answer LanguageServer::references(const json& parameters) {
  const bool with_definitions = is_true(member(parameters, "context", "includeDeclaration"));
  return at_place(parameters, [&](const View& view, std::size_t offset) {
    return lsp::references(view, offset, with_definitions);
  });
}

Answer LanguageServer::document_highlights(const json& parameters) {
  return at_place(parameters,
                  [](const View& view, std::size_t offset) { return lsp::document_highlights(view, offset); });
}

Answer LanguageServer::document_symbols(const json& parameters) {
  return at_document(parameters, [&](const View& view) { return lsp::document_symbols(view, client_); });
}

Answer LanguageServer::workspace_symbols(const json& parameters) {
  const auto query = text_of(member(parameters, "query"));
  if (!query) return invalid("expected params.query");
  return lsp::workspace_symbols(*workspace_, *query);
}

Answer LanguageServer::prepare_rename(const json& parameters) {
  return at_place(parameters, [](const View& view, std::size_t offset) { return lsp::prepare_rename(view, offset); });
}

Answer LanguageServer::rename(const json& parameters) {
  const auto new_name = text_of(member(parameters, "newName"));
  if (!new_name) return invalid("expected params.newName");
  const auto views = views_of(parameters);
  if (const auto* const error = std::get_if<ResponseError>(&views)) return *error;
  const std::optional<Position> position = position_of(member(parameters, "position"));
  if (!position) return invalid("expected params.position");
  const auto& found = std::get<std::vector<View>>(views);
  return lsp::rename(found, offset_in(found.front(), *position), *new_name);
}

Answer LanguageServer::semantic_tokens(const json& parameters) {
  return at_document(parameters, [](const View& view) { return lsp::semantic_tokens(view, 0, view.text().size()); });
}

Answer LanguageServer::semantic_tokens_of_range(const json& parameters) {
  return in_range(parameters, [](const View& view, std::size_t begin, std::size_t end) {
    return lsp::semantic_tokens(view, begin, end);
  });
}

Answer LanguageServer::folding_ranges(const json& parameters) {
  return at_document(parameters, [](const View& view) { return lsp::folding_ranges(view); });
}

Answer LanguageServer::formatting(const json& parameters) {
  return at_document(parameters, [](const View& view) { return lsp::formatting(view.document); });
}

Answer LanguageServer::range_formatting(const json& parameters) {
  return in_range(parameters, [](const View& view, std::size_t begin, std::size_t end) {
    return lsp::range_formatting(view.document, begin, end);
  });
}

Answer LanguageServer::code_actions(const json& parameters) {
  return in_range(parameters, [&](const View& view, std::size_t begin, std::size_t end) {
    return lsp::code_actions(view, begin, end, client_);
  });
}

}  // namespace opentmcl::editor::lsp
