#include "firmware/module/ascii_port.hpp"

namespace opentmcl {

namespace {

constexpr char backspace = '\b';
constexpr char erase_key = '\x7F';  // what many terminals send for backspace
constexpr char first_printing = ' ';
constexpr char last_printing = '~';
constexpr char tabulator = '\t';

}  // namespace

void AsciiPort::begin(const hal::Port& port, const GlobalParameterAccess& parameters) {
  port_ = port;
  parameters_ = &parameters;
  recipient_ = Recipient::nobody;
  length_ = 0;
}

std::size_t AsciiPort::read(std::uint8_t* buffer, std::size_t capacity) {
  // No room: the command before this one still waits for the EEPROM.
  if (capacity < datagram_size) return 0;
  std::uint8_t byte = 0;
  while (port_.bytes->read(&byte, 1) == 1) {
    Datagram request;
    if (!take(static_cast<char>(byte), request)) continue;
    for (std::size_t i = 0; i < datagram_size; ++i) buffer[i] = request.bytes[i];
    return datagram_size;
  }
  return 0;
}

void AsciiPort::write(const std::uint8_t* data, std::size_t) {
  Datagram reply;
  for (std::size_t i = 0; i < datagram_size; ++i) reply.bytes[i] = data[i];
  char text[longest_ascii_reply];
  send(text, format_ascii_reply(decode_reply(reply), text));
}

/// @return whether `request` holds a command now
bool AsciiPort::take(char character, Datagram& request) {
  if (character == carriage_return) return end_line(request);
  if (character == backspace || character == erase_key) {
    erase();
  } else if ((character >= first_printing && character <= last_printing) || character == tabulator) {
    append(character);
  }
  // Other control characters, such as the line feed of some terminals, mean nothing.
  return false;
}

void AsciiPort::append(char character) {
  if (length_ == 0) {
    if (character == first_printing || character == tabulator) return;
    recipient_ = recipient_of(character);
  }
  if (echoes(Echo::characters)) send(&character, 1);
  if (length_ < longest_line) line_[length_] = character;
  constexpr std::uint16_t most = 0xFFFF;
  if (length_ < most) ++length_;
}

void AsciiPort::erase() {
  if (length_ == 0) return;
  constexpr char blank_out[] = {backspace, ' ', backspace};
  if (echoes(Echo::characters)) send(blank_out, sizeof blank_out);
  if (--length_ == 0) recipient_ = Recipient::nobody;
}

/// @return whether `request` holds a command now
bool AsciiPort::end_line(Datagram& request) {
  constexpr char end = carriage_return;
  const bool fits = length_ <= longest_line;
  const std::size_t kept = fits ? length_ : longest_line;
  if (echoes(Echo::lines)) send(line_, kept);
  if (echoes(Echo::lines) || echoes(Echo::characters)) send(&end, 1);

  const Recipient recipient = recipient_;
  recipient_ = Recipient::nobody;
  length_ = 0;
  if (recipient != Recipient::this_module && recipient != Recipient::group) return false;
  Command command;
  const std::string_view text(line_ + 1, kept - 1);  // behind the address character
  const Status status = fits ? parse_ascii_command(text, command) : Status::invalid_command;
  if (status != Status::ok) {
    if (recipient == Recipient::this_module) refuse(status);
    return false;
  }
  request = encode(Request{address(recipient == Recipient::group ? GlobalParameter::serial_secondary_address
                                                                 : GlobalParameter::serial_address),
                           command});
  return true;
}

AsciiPort::Recipient AsciiPort::recipient_of(char address_character) const {
  // As with datagrams: there is nobody else at the end of a USB cable.
  if (port_.kind == hal::PortKind::usb) return Recipient::this_module;
  const auto names = [address_character](std::uint8_t address) {
    const char name = ascii_address(address);
    return address_character == name || (name >= 'A' && name <= 'Z' && address_character == name - 'A' + 'a');
  };
  if (names(address(GlobalParameter::serial_address))) return Recipient::this_module;
  const std::uint8_t group = address(GlobalParameter::serial_secondary_address);
  return group != 0 && names(group) ? Recipient::group : Recipient::other;
}

AsciiPort::Echo AsciiPort::echo() const {
  const std::int32_t mode = (*parameters_)[GlobalParameter::ascii_mode];
  if ((mode & no_echo) != 0) return Echo::none;
  return (mode & echo_lines) != 0 ? Echo::lines : Echo::characters;
}

void AsciiPort::send(const char* text, std::size_t length) {
  std::uint8_t bytes[longest_line];
  for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<std::uint8_t>(text[i]);
  port_.bytes->write(bytes, length);
}

/// Answers a line that is no command.
void AsciiPort::refuse(Status status) {
  if ((*parameters_)[GlobalParameter::suppress_reply] != 0) return;
  char text[longest_ascii_reply];
  send(text, format_ascii_reply(Reply{address(GlobalParameter::serial_host_address),
                                      address(GlobalParameter::serial_address), status, 0, 0},
                                text));
}

}  // namespace opentmcl
