#pragma once

#include <cstdint>

namespace opentmcl::hal {

/// One chip on the SPI bus, chip select included (the driver never touches a select line).
/// On silicon: an SPI peripheral in mode 3 and a GPIO. In the twin: a chip model.
class SpiDevice {
 public:
  /// Sends one word, most significant bit first, and returns what came back during the same transfer.
  /// TMC429: 32 bits. TMC262: 20 bits (the upper 12 bits of `word` are ignored, those of the result are 0).
  virtual std::uint32_t transfer(std::uint32_t word) = 0;

 protected:
  ~SpiDevice() = default;
};

}  // namespace opentmcl::hal
