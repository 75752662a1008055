// The language server: what the protocol says about messages, and the way from a request to its answer.
// Version 3.17 of the protocol; docs/editors.md lists what of it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "editor/lsp/protocol.hpp"
#include "editor/lsp/requests.hpp"
#include "editor/lsp/workspace.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::editor::lsp {

/// Answers one message after the other, and never waits. Whoever calls it reads and writes the messages (serve.hpp).
class LanguageServer {
 public:
  using Send = std::function<void(const json& message)>;

  /// @param disk where included files are that are not open; outlives the server
  LanguageServer(Send send, lang::FileProvider& disk);

  /// Takes a message of the client. Never fails: what is wrong with it is answered, or is nobody's business.
  void take(const json& message);
  /// A message that could not even be read.
  void refuse_message(const std::string& why);
  /// A request that the client has taken back before it was taken.
  void refuse_cancelled(const json& request);
  /// When no message waits: publishes what is wrong with the documents that have changed.
  void publish();

  /// After `exit`: 0 if `shutdown` came before it, else 1.
  std::optional<int> exit_code() const { return exit_code_; }

 private:
  enum class Stage : std::uint8_t { created, initializing, running, shut_down };

  struct Request {
    const char* method;
    Answer (LanguageServer::*handle)(const json& parameters);
  };
  struct Notification {
    const char* method;
    void (LanguageServer::*handle)(const json& parameters);
  };
  static const Request requests[];
  static const Notification notifications[];

  /// What was published last about a file.
  struct Published {
    json list = json::array();
    std::optional<std::int64_t> version;
  };

  void take_request(const json& id, const std::string& method, const json& parameters);
  void take_notification(const std::string& method, const json& parameters);
  void respond(const json& id, const Answer& answer);
  void notify(const char* method, json parameters);

  // Of the server itself.
  Answer initialize(const json& parameters);
  Answer shut_down(const json& parameters);
  void initialized(const json& parameters);
  void exit(const json& parameters);
  void take_settings(const json& settings);
  json capabilities() const;

  // Of documents.
  void open(const json& parameters);
  void change(const json& parameters);
  void close(const json& parameters);
  void save(const json& parameters);
  void change_settings(const json& parameters);
  void change_files(const json& parameters);

  // Requests about documents: requests.hpp.
  Answer hover(const json& parameters);
  Answer signature_help(const json& parameters);
  Answer inlay_hints(const json& parameters);
  Answer completion(const json& parameters);
  Answer definition(const json& parameters);
  Answer references(const json& parameters);
  Answer document_highlights(const json& parameters);
  Answer document_symbols(const json& parameters);
  Answer workspace_symbols(const json& parameters);
  Answer prepare_rename(const json& parameters);
  Answer rename(const json& parameters);
  Answer semantic_tokens(const json& parameters);
  Answer semantic_tokens_of_range(const json& parameters);
  Answer folding_ranges(const json& parameters);
  Answer formatting(const json& parameters);
  Answer range_formatting(const json& parameters);
  Answer code_actions(const json& parameters);

  /// The documents the parameters name, in each program it is a part of; why there is none.
  std::variant<std::vector<View>, ResponseError> views_of(const json& parameters);
  Answer at_document(const json& parameters, const std::function<Answer(const View&)>& look);
  Answer at_place(const json& parameters, const std::function<Answer(const View&, std::size_t offset)>& look);
  Answer in_range(const json& parameters,
                  const std::function<Answer(const View&, std::size_t begin, std::size_t end)>& look);
  void publish_file(const std::string& uri, json list);

  Send send_;
  lang::FileProvider* disk_;
  Stage stage_ = Stage::created;
  std::optional<int> exit_code_;
  ClientAbilities client_;
  PositionEncoding encoding_ = PositionEncoding::utf16;
  std::optional<Workspace> workspace_;          // from `initialize` on
  std::map<std::string, Published> published_;  // by URI
  bool has_changed_ = false;
};

}  // namespace opentmcl::editor::lsp
