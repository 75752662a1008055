#include "server/pty_endpoint.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include "server/pty.hpp"
#include "server/stream_line.hpp"

namespace opentmcl::server {

client::Result<PtyEndpoint> PtyEndpoint::open(boost::asio::io_context& events, RequestsArrived requests_arrived,
                                              WallClock clock, std::shared_ptr<RequestPort> port) {
  client::Result<Pty> pty = Pty::open();
  if (!pty) return pty.error();

  if (!port) port = std::make_shared<RequestPort>();
  using Stream = boost::asio::posix::basic_stream_descriptor<boost::asio::io_context::executor_type>;
  std::make_shared<StreamLine<Stream>>(Stream(events, pty->own_side.release()), port, std::move(requests_arrived),
                                       std::move(clock))
      ->read();
  return PtyEndpoint(std::move(port), std::move(pty->terminal), pty->path);
}

}  // namespace opentmcl::server
