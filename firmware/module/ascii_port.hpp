#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/hal/hal.hpp"
#include "firmware/param/global_parameter_access.hpp"
#include "firmware/wire/ascii_command.hpp"

namespace opentmcl {

/// A port in ASCII mode: gathers and echoes what is typed, hands each command line to the module as the datagram it
/// stands for, and sends the module's replies as text. So the rest of the module knows datagrams only.
/// Source: PD-1161 manual 3.4, docs/decisions/0017-ascii-mode.md.
class AsciiPort final : public hal::BytePort {
 public:
  /// Characters of a command line without its end; a longer line is refused when it ends.
  static constexpr std::size_t longest_line = 64;

  /// Begins with an empty line. @param parameters addresses and echo, which may change at any time
  void begin(const hal::Port& port, const GlobalParameterAccess& parameters);

  /// A whole datagram once a line has come that is a command, else nothing. What is no command is answered here.
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override;

  /// @param data one reply, as a datagram
  void write(const std::uint8_t* data, std::size_t length) override;

 private:
  enum class Echo : std::uint8_t { characters, lines, none };
  /// Whom the first character of the line addresses: somebody else, this module, or its secondary address.
  enum class Recipient : std::uint8_t { nobody, other, this_module, group };

  bool take(char character, Datagram& request);
  void erase();
  bool end_line(Datagram& request);
  void append(char character);
  Recipient recipient_of(char address) const;
  Echo echo() const;
  bool echoes(Echo kind) const { return recipient_ == Recipient::this_module && echo() == kind; }
  void send(const char* text, std::size_t length);
  void refuse(Status status);
  std::uint8_t address(GlobalParameter parameter) const { return static_cast<std::uint8_t>((*parameters_)[parameter]); }

  hal::Port port_{};
  const GlobalParameterAccess* parameters_ = nullptr;
  Recipient recipient_ = Recipient::nobody;
  std::uint16_t length_ = 0;  ///< characters typed since the line began, of which the first `longest_line` are kept
  char line_[longest_line];
};

}  // namespace opentmcl
