#pragma once

#include <string>

#include "client/file_descriptor.hpp"
#include "client/transport.hpp"

namespace opentmcl::client {

/// A connection through a file descriptor that reads and writes bytes: a serial port, a socket, one end of a pty.
class StreamTransport final : public Transport {
 public:
  /// Makes `stream` non-blocking.
  StreamTransport(FileDescriptor stream, std::string name);

  Result<void> send(std::span<const std::uint8_t> bytes) override;
  Result<std::size_t> receive(std::span<std::uint8_t> buffer, Duration limit) override;
  void drain() override;
  void pause(Duration duration) override;
  Duration now() const override;
  const std::string& name() const override { return name_; }

 private:
  Error gone(const std::string& reason) const;

  FileDescriptor stream_;
  std::string name_;
};

}  // namespace opentmcl::client
