#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "firmware/hal/can_port.hpp"

namespace opentmcl::tests {

/// A CAN bus as the module's controller sees it, with the test as the only other node.
class TestCan final : public hal::CanPort {
 public:
  void join(std::uint32_t speed) override { bit_rate = speed; }
  bool read(hal::CanFrame& frame) override {
    if (to_module.empty()) return false;
    frame = to_module.front();
    to_module.pop_front();
    return true;
  }
  void write(const hal::CanFrame& frame) override { received.push_back(frame); }

  std::uint32_t bit_rate = 0;  ///< bit/s; 0 until the module joined
  std::deque<hal::CanFrame> to_module;
  std::vector<hal::CanFrame> received;
};

}  // namespace opentmcl::tests
