#include "server/session_event.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include "server/hexadecimal.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::server {

namespace {

/// In front of a CAN identifier of 29 bits.
constexpr char extended_mark = 'x';

// ---- Writing

std::string hexadecimal_number(std::uint64_t number) {
  std::array<char, 16> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return {digits.data(), end};
}

struct TextOf {
  std::string operator()(const ExtraTurn&) const { return "turn"; }
  std::string operator()(const BytesRead& read) const {
    return "read " + std::to_string(read.port) + ' ' + hexadecimal(read.bytes);
  }
  std::string operator()(const FrameRead& read) const {
    const hal::CanFrame& frame = read.frame;
    std::string text = "can_read ";
    if (frame.is_extended) text += extended_mark;
    text += hexadecimal_number(frame.id);
    if (frame.length > 0) text += ' ' + hexadecimal({frame.data, frame.length});
    return text;
  }
  std::string operator()(const QuantitiesSet& set) const {
    std::string text = "set";
    for (const auto& [quantity, value] : set.values) text += ' ' + quantity + '=' + twin::text_of(value);
    return text;
  }
  std::string operator()(const ScenarioBegun& begun) const { return "begin " + std::to_string(begun.duration); }
  std::string operator()(const PowerCycled&) const { return "power_cycle"; }
  std::string operator()(const Check& check) const { return "check " + digests(check); }
  std::string operator()(const SessionEnd& end) const { return "end " + digests(end.check); }

  static std::string digests(const Check& check) {
    return hexadecimal_number(check.replies) + ' ' + hexadecimal_number(check.state);
  }
};

// ---- Reading

/// Takes the next word off `line`; empty when there is none.
std::string_view take_word(std::string_view& line) {
  const std::size_t end = std::min(line.find(' '), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  return word;
}

template <class Number>
std::optional<Number> number_of(std::string_view text, int base) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<double> real_of(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<BytesRead> bytes_read_from(std::string_view rest) {
  const auto port = number_of<unsigned>(take_word(rest), 10);
  auto bytes = bytes_of_hexadecimal(rest);
  if (!port || !bytes || bytes->empty()) return std::nullopt;
  return BytesRead{*port, std::move(*bytes)};
}

std::optional<FrameRead> frame_read_from(std::string_view rest) {
  std::string_view identifier = take_word(rest);
  hal::CanFrame frame;
  frame.is_extended = !identifier.empty() && identifier.front() == extended_mark;
  if (frame.is_extended) identifier.remove_prefix(1);
  const auto id = number_of<std::uint32_t>(identifier, 16);
  const auto bytes = bytes_of_hexadecimal(rest);
  if (!id || !bytes || bytes->size() > sizeof frame.data) return std::nullopt;
  frame.id = *id;
  frame.length = static_cast<std::uint8_t>(bytes->size());
  std::copy(bytes->begin(), bytes->end(), frame.data);
  return FrameRead{frame};
}

std::optional<QuantitiesSet> quantities_set_from(std::string_view rest) {
  QuantitiesSet set;
  while (!rest.empty()) {
    const std::string_view word = take_word(rest);
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const auto value = real_of(word.substr(equals + 1));
    if (!value) return std::nullopt;
    set.values.push_back({std::string(word.substr(0, equals)), *value});
  }
  if (set.values.empty()) return std::nullopt;
  return set;
}

std::optional<Check> check_from(std::string_view rest) {
  const auto replies = number_of<std::uint64_t>(take_word(rest), 16);
  const auto state = number_of<std::uint64_t>(rest, 16);
  if (!replies || !state) return std::nullopt;
  return Check{*replies, *state};
}

}  // namespace

bool operator==(const FrameRead& left, const FrameRead& right) {
  const hal::CanFrame& a = left.frame;
  const hal::CanFrame& b = right.frame;
  return a.id == b.id && a.is_extended == b.is_extended && a.length == b.length &&
         std::equal(a.data, a.data + a.length, b.data);
}

std::string text_of(const SessionEvent& event) {
  return std::to_string(event.time) + ' ' + std::visit(TextOf{}, event.what);
}

std::optional<SessionEvent> session_event_from(std::string_view line) {
  const auto time = number_of<Microseconds>(take_word(line), 10);
  if (!time) return std::nullopt;
  const std::string_view kind = take_word(line);
  // Put into a value that exists already: of a temporary GCC 12 believes, with sanitizers, that it is not initialized.
  SessionEvent event;
  event.time = *time;
  const auto with = [&event](auto what) -> std::optional<SessionEvent> {
    if (!what) return std::nullopt;
    event.what = std::move(*what);
    return std::move(event);
  };
  if (kind == "turn" && line.empty()) return SessionEvent{*time, ExtraTurn{}};
  if (kind == "read") return with(bytes_read_from(line));
  if (kind == "can_read") return with(frame_read_from(line));
  if (kind == "begin") {
    if (const auto duration = number_of<Microseconds>(line, 10)) return SessionEvent{*time, ScenarioBegun{*duration}};
  }
  if (kind == "set") return with(quantities_set_from(line));
  if (kind == "power_cycle" && line.empty()) return SessionEvent{*time, PowerCycled{}};
  if (kind == "check") return with(check_from(line));
  if (kind == "end") {
    if (const auto check = check_from(line)) return SessionEvent{*time, SessionEnd{*check}};
  }
  return std::nullopt;
}

}  // namespace opentmcl::server
