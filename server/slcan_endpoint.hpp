#pragma once

#include <memory>
#include <string>

#include "client/error.hpp"
#include "client/file_descriptor.hpp"
#include "server/pace.hpp"
#include "server/shared_can_port.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// A pseudo terminal that looks to a host like a serial CAN adapter with the module on its bus. What it understands is
/// SlcanChannel's affair. Hosts may open and close it as they like.
class SlcanEndpoint {
 public:
  /// @param requests_arrived called when `bus` has new frames
  /// @param clock gives time stamps
  /// Error: input_output.
  static client::Result<SlcanEndpoint> open(boost::asio::io_context& events, std::shared_ptr<CanBus> bus,
                                            RequestsArrived requests_arrived,
                                            WallClock clock = std::chrono::steady_clock::now);

  /// What a host opens: "/dev/pts/3".
  const std::string& path() const { return path_; }

 private:
  SlcanEndpoint(client::FileDescriptor terminal, std::string path)
      : terminal_(std::move(terminal)), path_(std::move(path)) {}

  client::FileDescriptor terminal_;
  std::string path_;
};

}  // namespace opentmcl::server
