#pragma once

#include <cstdint>

namespace opentmcl::hal {

/// A data frame of classical CAN.
struct CanFrame {
  std::uint32_t id = 0;      ///< 11 bits, or 29 when is_extended
  bool is_extended = false;  ///< 29-bit identifier
  std::uint8_t length = 0;   ///< data bytes, 0…8
  std::uint8_t data[8] = {};
};

/// A CAN controller that receives every frame on its bus. On silicon: the peripheral with a filter that lets all pass
/// and a queue for each direction.
class CanPort {
 public:
  /// Joins the bus, or leaves it and joins it again at another speed. Called before the first read() and write().
  /// @param bit_rate bit/s
  virtual void join(std::uint32_t bit_rate) = 0;

  /// Takes the oldest frame received; never waits. @return false when there is none
  virtual bool read(CanFrame& frame) = 0;

  /// Queues a frame for sending; never waits.
  virtual void write(const CanFrame& frame) = 0;

 protected:
  ~CanPort() = default;
};

}  // namespace opentmcl::hal
