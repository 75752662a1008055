#include "editor/lsp/workspace.hpp"

#include <algorithm>
#include <utility>

#include "editor/lsp/document_uri.hpp"

namespace opentmcl::editor::lsp {

// ---- Analysis

Analysis::Analysis(lang::AssemblyResult result, const ModuleDescription& module, PositionEncoding encoding)
    : result_(std::move(result)), module_(&module), encoding_(encoding) {}

const lang::NameIndex& Analysis::names() {
  if (names_ == nullptr) names_ = std::make_unique<lang::NameIndex>(result_.sources);
  return *names_;
}

const TextIndex& Analysis::text_index(lang::FileId file) {
  const auto found = text_indices_.find(file);
  if (found != text_indices_.end()) return found->second;
  return text_indices_.emplace(file, TextIndex(result_.sources[file].text, encoding_)).first->second;
}

std::optional<lang::FileId> Analysis::find(const std::string& path) const {
  for (lang::FileId file = 0; file < result_.sources.size(); ++file) {
    const lang::SourceFile& source = result_.sources[file];
    if (!source.is_built_in && source.name == path) return file;
  }
  return std::nullopt;
}

// ---- Document

Document::Document(std::string uri, std::string text, std::int64_t version, std::size_t number,
                   PositionEncoding encoding)
    : uri_(std::move(uri)),
      path_(path_of_uri(uri_).value_or(uri_)),
      version_(version),
      number_(number),
      encoding_(encoding) {
  set_text(std::move(text));
}

void Document::set_text(std::string text) {
  text_ = std::move(text);
  index_ = std::make_unique<TextIndex>(text_, encoding_);
}

// ---- Workspace

/// What is open as it is in the editor, everything else from the disk.
class Workspace::OpenFiles final : public lang::FileProvider {
 public:
  explicit OpenFiles(Workspace& workspace) : workspace_(&workspace) {}

  lang::FileContent read(const std::string& path) override {
    const auto found = workspace_->by_path_.find(path);
    if (found == workspace_->by_path_.end()) return workspace_->disk_->read(path);
    return {lang::FileContent::State::found, found->second->document->text()};
  }

 private:
  Workspace* workspace_;
};

void Workspace::set(Settings settings) {
  if (settings == settings_) return;
  settings_ = std::move(settings);
  note_change_of_files();
}

void Workspace::open(const std::string& uri, std::string text, std::int64_t version) {
  Entry& entry = entries_[uri];
  entry.document = std::make_unique<Document>(uri, std::move(text), version, next_number_++, encoding_);
  by_path_[entry.document->path()] = &entry;
  note_change_of_files();
}

void Workspace::close(const std::string& uri) {
  const auto found = entries_.find(uri);
  if (found == entries_.end()) return;
  by_path_.erase(found->second.document->path());
  entries_.erase(found);
  note_change_of_files();
}

void Workspace::note_change(const Document& document) {
  for (auto& [uri, entry] : entries_) {
    const bool has_it = entry.analysis != nullptr && entry.analysis->find(document.path()).has_value();
    if (has_it || entry.document.get() == &document) entry.analysis.reset();
  }
  is_fresh_ = false;
}

void Workspace::note_change_of_files() {
  for (auto& [uri, entry] : entries_) entry.analysis.reset();
  is_fresh_ = false;
}

Document* Workspace::find(const std::string& uri) {
  const auto found = entries_.find(uri);
  return found == entries_.end() ? nullptr : found->second.document.get();
}

std::vector<Document*> Workspace::documents() {
  std::vector<Document*> documents;
  for (Entry* const entry : in_order()) documents.push_back(entry->document.get());
  return documents;
}

std::vector<Workspace::Entry*> Workspace::in_order() {
  std::vector<Entry*> order;
  for (auto& [uri, entry] : entries_) order.push_back(&entry);
  std::sort(order.begin(), order.end(),
            [](const Entry* left, const Entry* right) { return left->document->number() < right->document->number(); });
  return order;
}

std::unique_ptr<Analysis> Workspace::analyse(const Document& document) {
  lang::AssemblerOptions options;
  const std::optional<lang::ModuleComment> comment = lang::module_named_in(document.text());
  options.module = comment && comment->module != nullptr ? comment->module : settings_.module;
  options.include_path = settings_.include_path;
  OpenFiles files(*this);
  return std::make_unique<Analysis>(lang::assemble(document.path(), document.text(), options, files), *options.module,
                                    encoding_);
}

void Workspace::refresh() {
  if (is_fresh_) return;
  const std::vector<Entry*> order = in_order();
  for (Entry* const entry : order) {
    if (entry->analysis == nullptr) entry->analysis = analyse(*entry->document);
  }
  for (Entry* const entry : order) {
    const std::string& path = entry->document->path();
    entry->is_root = std::none_of(order.begin(), order.end(), [&](const Entry* other) {
      if (other == entry || !other->analysis->find(path)) return false;
      // Of two that include each other the one that was opened first is the program.
      const bool is_mutual = entry->analysis->find(other->document->path()).has_value();
      return !is_mutual || other->document->number() < entry->document->number();
    });
  }
  is_fresh_ = true;
}

std::vector<Analysis*> Workspace::programs_of(const Document& document) {
  refresh();
  std::vector<Analysis*> found;
  Analysis* own = nullptr;
  for (Entry* const entry : in_order()) {
    if (entry->document.get() == &document) own = entry->analysis.get();
    if (entry->is_root && entry->analysis->find(document.path())) found.push_back(entry->analysis.get());
  }
  // In a ring of three nobody may be a program.
  if (found.empty()) found.push_back(own);
  return found;
}

std::vector<Analysis*> Workspace::programs() {
  std::vector<Analysis*> all;
  for (const Document* const document : documents()) {
    for (Analysis* const program : programs_of(*document)) {
      if (std::find(all.begin(), all.end(), program) == all.end()) all.push_back(program);
    }
  }
  return all;
}

lang::IncludeSearchResult Workspace::search_include(std::string_view name, const Document& document,
                                                    const ModuleDescription& module) {
  OpenFiles files(*this);
  return lang::search_include(name, document.path(), settings_.include_path, module, files);
}

std::string Workspace::uri_of(const lang::SourceFile& file) const {
  if (file.is_built_in) return {};
  const auto found = by_path_.find(file.name);
  return found == by_path_.end() ? uri_of_path(file.name) : found->second->document->uri();
}

}  // namespace opentmcl::editor::lsp
