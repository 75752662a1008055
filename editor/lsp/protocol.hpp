// What the requests of the protocol are made of: reading their parameters without trusting them, and writing places.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

#include "editor/lsp/text_index.hpp"

namespace opentmcl::editor::lsp {

using nlohmann::json;

enum class ErrorCode : int {
  parse_error = -32700,
  invalid_request = -32600,
  method_not_found = -32601,
  invalid_parameters = -32602,
  server_not_initialized = -32002,
  request_failed = -32803,
  request_cancelled = -32800,
};

struct ResponseError {
  ErrorCode code;
  std::string message;
};

/// The result of a request, or why it has none.
using Answer = std::variant<json, ResponseError>;

/// The member of this name; null if there is none, or `object` is no object.
const json& member(const json& object, const char* name);
/// A member of a member: `params.textDocument.uri`.
const json& member(const json& object, const char* name, const char* inner_name);

std::optional<std::string> text_of(const json& value);
std::optional<Position> position_of(const json& value);

struct Range {
  Position start;
  Position end;
};
std::optional<Range> range_of(const json& value);

json to_json(Position position);
/// `length` bytes from `offset` on.
json range_json(const TextIndex& index, std::size_t offset, std::size_t length);

json text_edit(json range, std::string text);

// The enumerations of the protocol, as far as they are used.
enum class SeverityCode : int { error = 1, warning = 2 };
enum class DiagnosticTagCode : int { unnecessary = 1 };
enum class SymbolKindCode : int { function = 12, constant = 14, file = 1 };
enum class CompletionItemKindCode : int {
  function = 3,
  keyword = 14,
  value = 12,
  enum_member = 20,
  constant = 21,
  reference = 18,
  file = 17,
};
enum class InlayHintKindCode : int { type = 1, parameter = 2 };
enum class HighlightKindCode : int { read = 2, write = 3 };
enum class SyncKindCode : int { incremental = 2 };

template <class Code>
constexpr int number_of(Code code) {
  return static_cast<int>(code);
}

}  // namespace opentmcl::editor::lsp
