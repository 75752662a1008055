#pragma once

#include <cstdint>
#include <vector>

#include "server/request_port.hpp"

namespace opentmcl::server {

/// A host in the same process at a port of its own.
class MemoryLine final : public ReplySink {
 public:
  MemoryLine() = default;
  MemoryLine(const MemoryLine&) = delete;
  MemoryLine& operator=(const MemoryLine&) = delete;

  RequestPort& port() { return port_; }

  void send(const Datagram& request) { port_.push(request, *this); }

  /// Bytes the module has sent; whoever takes them removes them.
  std::vector<std::uint8_t>& received() { return received_; }

  void reply(std::span<const std::uint8_t> bytes) override {
    received_.insert(received_.end(), bytes.begin(), bytes.end());
  }

 private:
  RequestPort port_;
  std::vector<std::uint8_t> received_;
};

}  // namespace opentmcl::server
