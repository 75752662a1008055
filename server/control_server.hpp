#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "client/error.hpp"
#include "server/control.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// The control interface on a Unix stream socket: JSON-RPC 2.0, one JSON text a line, for any number of clients of the
/// same user (docs/control.md).
class ControlServer {
 public:
  static constexpr std::size_t most_clients = 64;
  /// Longer requests are refused, and the client is cut off.
  static constexpr std::size_t longest_request = 1 << 20;
  /// So much may wait for a client to read it; one that is slower is cut off.
  static constexpr std::size_t longest_backlog = 4 << 20;

  /// Listens at `path`. A socket that is left over from a program that was killed is replaced.
  /// @param control outlives the server
  /// Errors: usage (the path is too long), input_output (somebody else listens there, or it is no socket).
  static client::Result<ControlServer> listen(boost::asio::io_context& events, const std::string& path,
                                              Control& control);

  ControlServer(ControlServer&&) noexcept;
  ControlServer& operator=(ControlServer&&) = delete;
  /// Removes the socket and cuts all clients off.
  ~ControlServer();

  const std::string& path() const;

 private:
  class Listener;

  explicit ControlServer(std::shared_ptr<Listener> listener);

  std::shared_ptr<Listener> listener_;
};

/// Where the control interface is when the user does not say: beside the link to the module's serial port.
std::string control_path_of(const std::string& link);

}  // namespace opentmcl::server
