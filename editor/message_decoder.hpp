#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace opentmcl::editor {

/// Cuts a stream of bytes into messages, as the base protocol of the Language Server Protocol and of the Debug Adapter
/// Protocol has it: header fields, each with CR LF at its end, an empty line, and as many bytes as the field
/// Content-Length says. Knows nothing of where the bytes come from.
class MessageDecoder {
 public:
  static constexpr std::size_t longest_header = 8192;
  static constexpr std::size_t longest_body = std::size_t{64} << 20;

  /// Takes what has arrived.
  void append(std::string_view bytes);

  /// The body of the next message; none if it has not arrived as a whole, or after an error.
  std::optional<std::string> next();

  /// What is wrong with the stream, "" for nothing. From there on nobody knows where a message begins.
  const std::string& error() const { return error_; }

  /// Whether a message has begun and not ended.
  bool is_within_message() const { return begin_ < bytes_.size(); }

 private:
  bool read_header();
  void read_field(std::string_view field);
  void fail(std::string error);

  std::string bytes_;  // what has arrived, from begin_ on not yet given away
  std::size_t begin_ = 0;
  std::size_t searched_ = 0;  // no end of the header begins before it
  std::optional<std::size_t> body_size_;
  std::string error_;
};

/// A body as it goes over the wire.
std::string with_header(std::string_view body);

}  // namespace opentmcl::editor
