// Everything the firmware asks of a board, in one place.
#pragma once

#include "firmware/hal/analog.hpp"
#include "firmware/hal/byte_port.hpp"
#include "firmware/hal/can_port.hpp"
#include "firmware/hal/eeprom.hpp"
#include "firmware/hal/encoder.hpp"
#include "firmware/hal/pins.hpp"
#include "firmware/hal/spi_device.hpp"
#include "firmware/hal/time.hpp"

namespace opentmcl {

namespace hal {

/// What is at the other end of a byte port. It decides whether the address byte is looked at.
enum class PortKind : std::uint8_t {
  usb,    ///< point to point: the address byte of a request is ignored
  rs232,  ///< point to point, but addressed as on RS485
  rs485,  ///< a bus: silence when the request is for another address
  can,    ///< frames whose identifiers were compared already: Hal::can, never a byte port of a board
};

struct Port {
  BytePort* bytes;
  PortKind kind;
};

}  // namespace hal

/// The board as the firmware sees it; all references must outlive the Module.
struct Hal {
  hal::SpiDevice& tmc429;
  hal::SpiDevice& tmc262;
  hal::Eeprom& eeprom;
  hal::Pins& pins;
  hal::Analog& analog;
  hal::Encoder& encoder;
  const hal::Port* ports;
  std::uint8_t port_count;      ///< 1…4
  hal::CanPort* can = nullptr;  ///< none on a board without CAN
};

}  // namespace opentmcl
