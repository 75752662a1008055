#include "server/slcan_channel.hpp"

#include <array>
#include <charconv>
#include <cstdio>
#include <utility>

namespace opentmcl::server {

namespace {

constexpr char end_of_line = '\r';
constexpr const char* done = "\r";
constexpr const char* bell = "\a";

constexpr int standard_id_digits = 3;
constexpr int extended_id_digits = 8;

/// T with identifier, length, data: the longest line there is. What is longer is kept as one byte too long.
constexpr std::size_t longest_line = 1 + extended_id_digits + 1 + 2 * 8;

/// By the digit of S, bit/s. S9 is not of the CANUSB but of hosts.
constexpr std::array<std::uint32_t, 10> bit_rates{10'000,  20'000,  50'000,  100'000,   125'000,
                                                  250'000, 500'000, 800'000, 1'000'000, 83'300};

/// Flags of F. A frame that nobody acknowledges is an error on the bus, and an adapter that tries again and again
/// becomes error passive.
constexpr std::uint8_t error_warning = 1U << 2;
constexpr std::uint8_t error_passive = 1U << 5;
constexpr std::uint8_t bus_error = 1U << 7;

std::optional<std::uint32_t> parse_hexadecimal(std::string_view digits) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

std::optional<std::uint32_t> bit_rate_of_digit(std::string_view digit) {
  if (digit.size() != 1 || digit[0] < '0' || digit[0] > '9') return std::nullopt;
  return bit_rates[static_cast<std::size_t>(digit[0] - '0')];
}

/// From the two bit timing registers of an SJA1000 at 16 MHz, as four hexadecimal digits.
std::optional<std::uint32_t> bit_rate_of_registers(std::string_view digits) {
  const std::optional<std::uint32_t> registers = digits.size() == 4 ? parse_hexadecimal(digits) : std::nullopt;
  if (!registers) return std::nullopt;
  constexpr std::uint32_t half_clock = 8'000'000;
  const std::uint32_t prescaler = (*registers >> 8 & 0x3F) + 1;
  const std::uint32_t quanta = 1 + (*registers & 0xF) + 1 + (*registers >> 4 & 0x7) + 1;
  return half_clock / (prescaler * quanta);
}

struct SlcanFrame {
  hal::CanFrame frame;
  bool is_remote;
};

/// @param line t, T, r or R and what belongs to it
std::optional<SlcanFrame> parse_frame(std::string_view line) {
  SlcanFrame result{};
  result.is_remote = line[0] == 'r' || line[0] == 'R';
  hal::CanFrame& frame = result.frame;
  frame.is_extended = line[0] == 'T' || line[0] == 'R';
  const std::size_t id_digits = frame.is_extended ? extended_id_digits : standard_id_digits;
  const std::uint32_t highest_id = frame.is_extended ? 0x1FFF'FFFF : 0x7FF;
  line.remove_prefix(1);
  if (line.size() <= id_digits) return std::nullopt;

  const std::optional<std::uint32_t> id = parse_hexadecimal(line.substr(0, id_digits));
  const char length = line[id_digits];
  line.remove_prefix(id_digits + 1);
  if (!id || *id > highest_id || length < '0' || length > '8') return std::nullopt;
  frame.id = *id;
  frame.length = static_cast<std::uint8_t>(length - '0');

  const std::size_t data_bytes = result.is_remote ? 0 : frame.length;
  if (line.size() != 2 * data_bytes) return std::nullopt;
  for (std::size_t i = 0; i < data_bytes; ++i) {
    const std::optional<std::uint32_t> byte = parse_hexadecimal(line.substr(2 * i, 2));
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return result;
}

void append_hexadecimal(std::string& text, std::uint32_t number, int digits) {
  char buffer[9];
  std::snprintf(buffer, sizeof buffer, "%0*X", digits, static_cast<unsigned>(number));
  text += buffer;
}

}  // namespace

SlcanChannel::SlcanChannel(CanBus& bus, Write write, WallClock clock)
    : bus_(bus), write_(std::move(write)), clock_(std::move(clock)) {}

bool SlcanChannel::take(std::span<const std::uint8_t> bytes) {
  has_sent_ = false;
  std::string answers;
  for (const std::uint8_t byte : bytes) {
    const char character = static_cast<char>(byte);
    if (character == end_of_line) {
      answers += answer_to(line_);
      line_.clear();
    } else if (line_.size() <= longest_line) {
      line_ += character;
    }
  }
  if (!answers.empty()) write_(answers);
  return has_sent_;
}

std::string SlcanChannel::answer_to(std::string_view line) {
  // Hosts clear the adapter's buffer with empty lines.
  if (line.empty()) return done;
  const auto done_if = [](bool is_done) -> std::string { return is_done ? done : bell; };
  const std::string_view operand = line.substr(1);
  switch (line[0]) {
    case 'S':
      return done_if(set_bit_rate(bit_rate_of_digit(operand)));
    case 's':
      return done_if(set_bit_rate(bit_rate_of_registers(operand)));
    case 'Z':
      return done_if(set_time_stamps(operand));
    case 'O':
      return done_if(operand.empty() && open(State::open));
    case 'L':
      return done_if(operand.empty() && open(State::listening));
    case 'C':
      return done_if(operand.empty() && close());
    case 't':
    case 'T':
    case 'r':
    case 'R':
      return put_on_bus(line);
    case 'F':
      return operand.empty() && state_ != State::closed ? status_flags() : bell;
    case 'V':
      return operand.empty() ? "V1010\r" : bell;  // hardware 1.0, software 1.0
    case 'N':
      return operand.empty() ? "NTMCL\r" : bell;  // four characters
    default:
      return bell;
  }
}

bool SlcanChannel::set_bit_rate(std::optional<std::uint32_t> bit_rate) {
  if (!bit_rate || state_ != State::closed) return false;
  bit_rate_ = bit_rate;
  return true;
}

bool SlcanChannel::set_time_stamps(std::string_view digit) {
  if ((digit != "0" && digit != "1") || state_ != State::closed) return false;
  has_time_stamps_ = digit == "1";
  return true;
}

bool SlcanChannel::open(State state) {
  if (state_ != State::closed) return false;
  state_ = state;
  flags_ = 0;
  return true;
}

bool SlcanChannel::close() {
  if (state_ == State::closed) return false;
  state_ = State::closed;
  return true;
}

std::string SlcanChannel::put_on_bus(std::string_view line) {
  const std::optional<SlcanFrame> parsed = parse_frame(line);
  if (!parsed || state_ != State::open) return bell;
  if (!hears_module()) {
    flags_ |= error_warning | error_passive | bus_error;
  } else if (!parsed->is_remote) {  // to which no TMCL module answers
    bus_.push(parsed->frame, *this);
    has_sent_ = true;
  }
  return parsed->frame.is_extended ? "Z\r" : "z\r";
}

std::string SlcanChannel::status_flags() {
  std::string text = "F";
  append_hexadecimal(text, std::exchange(flags_, std::uint8_t{0}), 2);
  return text += done;
}

bool SlcanChannel::hears_module() const {
  return state_ != State::closed && (!bit_rate_ || *bit_rate_ == bus_.bit_rate());
}

/// Milliseconds of the present minute.
std::uint32_t SlcanChannel::time_stamp() const {
  constexpr std::int64_t one_minute = 60'000;
  const auto time = std::chrono::duration_cast<std::chrono::milliseconds>(clock_().time_since_epoch()).count();
  return static_cast<std::uint32_t>(time % one_minute);
}

void SlcanChannel::send(const hal::CanFrame& frame) {
  if (!hears_module()) return;
  std::string text(1, frame.is_extended ? 'T' : 't');
  append_hexadecimal(text, frame.id, frame.is_extended ? extended_id_digits : standard_id_digits);
  append_hexadecimal(text, frame.length, 1);
  for (std::size_t i = 0; i < frame.length; ++i) append_hexadecimal(text, frame.data[i], 2);
  if (has_time_stamps_) append_hexadecimal(text, time_stamp(), 4);
  write_(text += done);
}

}  // namespace opentmcl::server
