#include "editor/message_decoder.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

namespace opentmcl::editor {
namespace {

constexpr std::string_view end_of_field = "\r\n";
constexpr std::string_view end_of_header = "\r\n\r\n";
constexpr std::string_view length_field = "Content-Length";

char to_lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Names of fields have no case (RFC 7230, to which the protocol refers).
bool is_same_field(std::string_view left, std::string_view right) {
  return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                    [](char a, char b) { return to_lower(a) == to_lower(b); });
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// A piece of the stream as a message can show it.
std::string quoted(std::string_view text) {
  constexpr std::size_t shown_length = 60;
  std::string result = "'";
  for (const char c : text.substr(0, shown_length)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > shown_length ? "...'" : "'");
}

}  // namespace

void MessageDecoder::append(std::string_view bytes) {
  if (!error_.empty()) return;
  if (begin_ == bytes_.size()) {
    bytes_.clear();
    searched_ -= begin_;
    begin_ = 0;
  }
  bytes_ += bytes;
}

std::optional<std::string> MessageDecoder::next() {
  if (!error_.empty()) return std::nullopt;
  if (!body_size_ && !read_header()) return std::nullopt;
  if (bytes_.size() - begin_ < *body_size_) return std::nullopt;
  std::string body = bytes_.substr(begin_, *body_size_);
  begin_ += *body_size_;
  searched_ = begin_;
  body_size_.reset();
  // Given away in pieces, so that many small messages in one large read are not moved again and again.
  if (begin_ > bytes_.size() / 2) {
    bytes_.erase(0, begin_);
    begin_ = searched_ = 0;
  }
  return body;
}

bool MessageDecoder::read_header() {
  const std::size_t end = bytes_.find(end_of_header, searched_);
  const std::size_t size = (end == std::string::npos ? bytes_.size() : end) - begin_;
  if (size > longest_header) {
    fail("the header of a message is longer than " + std::to_string(longest_header) + " bytes");
    return false;
  }
  if (end == std::string::npos) {
    searched_ = bytes_.size() - std::min(size, end_of_header.size() - 1);
    return false;
  }
  std::string_view header = std::string_view(bytes_).substr(begin_, size);
  while (!header.empty() && error_.empty()) {
    const std::size_t field_end = std::min(header.find(end_of_field), header.size());
    read_field(header.substr(0, field_end));
    header.remove_prefix(std::min(field_end + end_of_field.size(), header.size()));
  }
  if (error_.empty() && !body_size_) fail("the header of a message has no field Content-Length");
  if (!error_.empty()) return false;
  begin_ = end + end_of_header.size();
  return true;
}

void MessageDecoder::read_field(std::string_view field) {
  const std::size_t colon = field.find(':');
  if (colon == std::string_view::npos) {
    return fail("expected a header field such as 'Content-Length: 100', not " + quoted(field));
  }
  // The other field the protocols know, Content-Type, has one meaning only: JSON in UTF-8.
  if (!is_same_field(without_blanks(field.substr(0, colon)), length_field)) return;
  const std::string_view number = without_blanks(field.substr(colon + 1));
  std::size_t size = 0;
  const auto [after, failure] = std::from_chars(number.data(), number.data() + number.size(), size);
  if (failure == std::errc::invalid_argument || after != number.data() + number.size()) {
    return fail("Content-Length must be a number of bytes, not " + quoted(number));
  }
  if (failure != std::errc() || size > longest_body) {
    return fail("Content-Length is " + quoted(number) + "; messages have at most " + std::to_string(longest_body) +
                " bytes");
  }
  if (body_size_ && *body_size_ != size) return fail("the header of a message has two different fields Content-Length");
  body_size_ = size;
}

void MessageDecoder::fail(std::string error) {
  error_ = std::move(error);
  body_size_.reset();
}

std::string with_header(std::string_view body) {
  std::string message(length_field);
  message.append(": ").append(std::to_string(body.size())).append(end_of_header).append(body);
  return message;
}

}  // namespace opentmcl::editor
