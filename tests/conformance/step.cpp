#include "tests/conformance/step.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "lang/assembler.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::conformance {

namespace {

std::string_view trim(std::string_view text) {
  constexpr const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Splits at the first `separator`; the second part is empty when there is none.
std::pair<std::string_view, std::string_view> split(std::string_view text, std::string_view separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return {trim(text), {}};
  return {trim(text.substr(0, at)), trim(text.substr(at + separator.size()))};
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  while (!(text = trim(text)).empty()) {
    const std::size_t end = std::min(text.find_first_of(" \t,"), text.size());
    if (end > 0) words.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.substr(0, word.size()) == word && (text.size() == word.size() || text[word.size()] == ' ');
}

std::int64_t parse_number(std::string_view text) {
  const bool is_hexadecimal = text.substr(0, 1) == "$";
  std::int64_t number = 0;
  const char* const begin = text.data() + (is_hexadecimal ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, number, is_hexadecimal ? 16 : 10);
  if (text.empty() || error != std::errc{} || stop != end) {
    throw std::runtime_error("expected a number, found \"" + std::string(text) + '"');
  }
  return number;
}

Range parse_range(std::string_view text) {
  const auto [low, high] = split(text, "..");
  const std::int64_t minimum = parse_number(low);
  return {minimum, high.empty() ? minimum : parse_number(high)};
}

Microseconds parse_time(std::string_view text) {
  const auto [number, unit] = split(text, " ");
  const std::int64_t count = parse_number(number);
  if (unit == "us") return static_cast<Microseconds>(count);
  if (unit == "ms") return static_cast<Microseconds>(count) * one_millisecond;
  if (unit == "s") return static_cast<Microseconds>(count) * 1000 * one_millisecond;
  throw std::runtime_error("expected a time in us, ms or s, found \"" + std::string(text) + '"');
}

/// Hexadecimal bytes, or a text in quotes in which \r, \n and \b stand for the control characters.
Bytes parse_bytes(std::string_view text) {
  if (text == "nothing") return {};
  Bytes bytes;
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = text.substr(1, text.size() - 2);
    for (std::size_t i = 0; i < text.size(); ++i) {
      char character = text[i];
      if (character == '\\' && i + 1 < text.size()) {
        ++i;
        if (text[i] != 'r' && text[i] != 'b' && text[i] != 'n') throw std::runtime_error("unknown escape in a text");
        character = text[i] == 'r' ? '\r' : text[i] == 'n' ? '\n' : '\b';
      }
      bytes.push_back(static_cast<std::uint8_t>(character));
    }
    return bytes;
  }
  for (const std::string_view word : words_of(text)) {
    unsigned byte = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), byte, 16);
    if (error != std::errc{} || stop != word.data() + word.size() || word.size() != 2) {
      throw std::runtime_error("expected two hexadecimal digits, found \"" + std::string(word) + '"');
    }
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return bytes;
}

/// Identifier of 3 hexadecimal digits for 11 bits or 8 for 29, then the data bytes.
hal::CanFrame parse_frame(std::string_view text) {
  constexpr std::size_t standard_digits = 3;
  constexpr std::size_t extended_digits = 8;
  const auto [id, data] = split(text, " ");
  if (id.size() != standard_digits && id.size() != extended_digits) {
    throw std::runtime_error("expected an identifier of 3 or 8 hexadecimal digits");
  }
  const Bytes bytes = parse_bytes(data);
  hal::CanFrame frame;
  if (bytes.size() > sizeof frame.data) throw std::runtime_error("a frame has at most 8 bytes");
  frame.id = static_cast<std::uint32_t>(parse_number('$' + std::string(id)));
  frame.is_extended = id.size() == extended_digits;
  frame.length = static_cast<std::uint8_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), frame.data);
  return frame;
}

/// "MVP ABS, 0, 1000", or four numbers: opcode, type, motor or bank, value.
Command parse_command(std::string_view text, const ModuleDescription& module) {
  if (std::isdigit(static_cast<unsigned char>(text.front())) != 0) {
    const std::vector<std::string_view> words = words_of(text);
    if (words.size() != 4) throw std::runtime_error("expected opcode, type, motor or bank, and value");
    std::int64_t fields[4] = {};
    std::transform(words.begin(), words.end(), fields, parse_number);
    return {static_cast<std::uint8_t>(fields[0]), static_cast<std::uint8_t>(fields[1]),
            static_cast<std::uint8_t>(fields[2]), static_cast<std::int32_t>(fields[3])};
  }
  const lang::InstructionResult result = lang::parse_instruction(text, module);
  if (!result.command) throw std::runtime_error(lang::format(result.diagnostics, result.sources));
  return *result.command;
}

std::optional<ExpectedReply> parse_reply(std::string_view text) {
  if (text == "nothing") return std::nullopt;
  const auto [status, value] = split(text, ",");
  ExpectedReply reply;
  reply.status = static_cast<std::uint8_t>(parse_number(status));
  if (!value.empty()) reply.value = parse_range(value);
  return reply;
}

Action parse_action(std::string_view line, const ModuleDescription& module) {
  if (line == "power cycle") return PowerCycle{};
  if (starts_with_word(line, "wait")) return Wait{parse_time(trim(line.substr(4)))};
  if (starts_with_word(line, "run")) {
    const std::string_view address = trim(line.substr(3));
    return RunProgram{address.empty() ? 0 : static_cast<std::int32_t>(parse_number(address))};
  }
  if (starts_with_word(line, "set")) {
    const auto [name, value] = split(line.substr(3), "=");
    return SetWorld{std::string(name), parse_number(value)};
  }
  if (starts_with_word(line, "check")) {
    const auto [name, value] = split(line.substr(5), "=");
    return CheckWorld{std::string(name), parse_range(value)};
  }
  if (starts_with_word(line, "until")) {
    const auto [condition, limit] = split(line.substr(5), " within ");
    const auto [command, value] = split(condition, "=");
    return WaitUntil{parse_command(command, module), parse_range(value), parse_time(limit)};
  }
  if (starts_with_word(line, "receive")) {
    const auto [bytes, limit] = split(line.substr(7), " within ");
    return Receive{parse_bytes(bytes), parse_time(limit)};
  }
  const auto [sent, reply] = split(line, "->");
  if (reply.empty()) throw std::runtime_error("expected -> and what must come back");
  if (starts_with_word(sent, "bytes")) return SendBytes{parse_bytes(trim(sent.substr(5))), parse_bytes(reply)};
  if (starts_with_word(sent, "frame")) {
    SendFrame step{parse_frame(trim(sent.substr(5))), std::nullopt};
    if (reply != "nothing") step.reply = parse_frame(reply);
    return step;
  }
  return SendCommand{parse_command(sent, module), parse_reply(reply)};
}

}  // namespace

std::vector<Step> parse_steps(std::string_view text, const ModuleDescription& module) {
  std::vector<Step> steps;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = split(text.substr(0, end), "//").first;
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    try {
      steps.push_back({std::string(line), parse_action(line, module)});
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("step \"" + std::string(line) + "\": " + error.what());
    }
  }
  return steps;
}

}  // namespace opentmcl::conformance
