#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "editor/lsp/text_index.hpp"
#include "firmware/spec/modules.hpp"
#include "lang/assembler.hpp"
#include "lang/file_provider.hpp"
#include "lang/include_search.hpp"
#include "lang/module_comment.hpp"
#include "lang/name_index.hpp"

namespace opentmcl::editor::lsp {

/// What the user can choose.
struct Settings {
  const ModuleDescription* module = &pd1161;  ///< of sources that do not say it themselves
  std::vector<std::string> include_path;      ///< as AssemblerOptions has it

  friend bool operator==(const Settings&, const Settings&) = default;
};

/// A program as the assembler sees it: a file that no other open one includes, and all it includes.
class Analysis {
 public:
  Analysis(lang::AssemblyResult result, const ModuleDescription& module, PositionEncoding encoding);

  const ModuleDescription& module() const { return *module_; }
  const lang::AssemblyResult& result() const { return result_; }
  const lang::Sources& sources() const { return result_.sources; }
  /// Evaluating an expression marks the names in it, hence not constant.
  lang::SymbolTable& symbols() { return result_.symbols; }

  // What most changes of a text do not need is made when it is asked for.
  const lang::NameIndex& names();
  const TextIndex& text_index(lang::FileId file);

  /// The file of this path, if it is a part of the program.
  std::optional<lang::FileId> find(const std::string& path) const;

 private:
  lang::AssemblyResult result_;
  const ModuleDescription* module_;
  PositionEncoding encoding_;
  std::unique_ptr<lang::NameIndex> names_;
  std::map<lang::FileId, TextIndex> text_indices_;
};

/// A file as the editor has it, saved or not.
class Document {
 public:
  Document(std::string uri, std::string text, std::int64_t version, std::size_t number, PositionEncoding encoding);

  const std::string& uri() const { return uri_; }
  /// By which others include it; the URI for what is no file.
  const std::string& path() const { return path_; }
  const std::string& text() const { return text_; }
  const TextIndex& index() const { return *index_; }
  std::int64_t version() const { return version_; }
  /// Documents that were opened later have higher ones.
  std::size_t number() const { return number_; }

  void set_text(std::string text);
  void set_version(std::int64_t version) { version_ = version; }

 private:
  std::string uri_;
  std::string path_;
  std::string text_;
  std::int64_t version_;
  std::size_t number_;
  PositionEncoding encoding_;
  std::unique_ptr<TextIndex> index_;
};

/// All open documents, and the programs they are. A document that an open one includes belongs to that one's program;
/// each other one is a program of its own.
class Workspace {
 public:
  /// @param disk where files are that are not open; outlives the workspace
  Workspace(lang::FileProvider& disk, PositionEncoding encoding) : disk_(&disk), encoding_(encoding) {}

  const Settings& settings() const { return settings_; }
  void set(Settings settings);

  void open(const std::string& uri, std::string text, std::int64_t version);
  void close(const std::string& uri);
  /// After the text of a document has changed.
  void note_change(const Document& document);
  /// After files have changed that may be included.
  void note_change_of_files();

  /// nullptr if it is not open.
  Document* find(const std::string& uri);
  /// In the order they were opened in.
  std::vector<Document*> documents();

  /// The programs that a document is a part of, at least one, those that were opened first before the others. Valid
  /// until the next change.
  std::vector<Analysis*> programs_of(const Document& document);
  /// All programs, each once.
  std::vector<Analysis*> programs();

  /// The file that `#include name` in a document is.
  lang::IncludeSearchResult search_include(std::string_view name, const Document& document,
                                           const ModuleDescription& module);

  /// As the client names the file: what is open by its own URI. Empty for a built-in file.
  std::string uri_of(const lang::SourceFile& file) const;

 private:
  class OpenFiles;

  /// A document with what it would be as a program.
  struct Entry {
    std::unique_ptr<Document> document;
    std::unique_ptr<Analysis> analysis;  // none if it has to be made again
    bool is_root = false;
  };

  void refresh();
  std::unique_ptr<Analysis> analyse(const Document& document);
  std::vector<Entry*> in_order();

  lang::FileProvider* disk_;
  PositionEncoding encoding_;
  Settings settings_;
  std::map<std::string, Entry> entries_;  // by URI
  std::map<std::string, Entry*> by_path_;
  std::size_t next_number_ = 0;
  bool is_fresh_ = false;
};

}  // namespace opentmcl::editor::lsp
