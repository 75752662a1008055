#include "server/tcp_endpoint.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "server/stream_line.hpp"

namespace opentmcl::server {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

/// Accepts one connection after the other; lives as long as an accept is pending.
class Acceptor : public std::enable_shared_from_this<Acceptor> {
 public:
  Acceptor(tcp::acceptor acceptor, std::shared_ptr<RequestPort> port, RequestsArrived requests_arrived, WallClock clock)
      : acceptor_(std::move(acceptor)),
        port_(std::move(port)),
        requests_arrived_(std::move(requests_arrived)),
        clock_(std::move(clock)) {}

  void accept() {
    acceptor_.async_accept([self = shared_from_this()](const boost::system::error_code& error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error) self->serve(std::move(socket));
      self->accept();
    });
  }

 private:
  void serve(tcp::socket socket) {
    boost::system::error_code only_slower_without;
    socket.set_option(tcp::no_delay(true), only_slower_without);
    std::make_shared<StreamLine<tcp::socket>>(std::move(socket), port_, requests_arrived_, clock_)->read();
  }

  tcp::acceptor acceptor_;
  std::shared_ptr<RequestPort> port_;
  RequestsArrived requests_arrived_;
  WallClock clock_;
};

client::Error cannot_listen(const std::string& where, const boost::system::error_code& error) {
  return {client::ErrorKind::input_output, "cannot listen on " + where + ": " + error.message(), {}};
}

}  // namespace

client::Result<TcpEndpoint> TcpEndpoint::listen(asio::io_context& events, const std::string& address,
                                                std::uint16_t port, RequestsArrived requests_arrived, WallClock clock,
                                                std::shared_ptr<RequestPort> requests) {
  const std::string where = address + " port " + std::to_string(port);
  boost::system::error_code error;
  const asio::ip::address parsed = asio::ip::make_address(address, error);
  if (error) {
    return client::Error{client::ErrorKind::usage, "\"" + address + "\" is no IP address to listen on", {}};
  }
  const tcp::endpoint endpoint(parsed, port);
  tcp::acceptor acceptor(events);
  acceptor.open(endpoint.protocol(), error);
  if (error) return cannot_listen(where, error);
  // A port whose last connection has just been closed is free again.
  acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  acceptor.bind(endpoint, error);
  if (error) return cannot_listen(where, error);
  acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return cannot_listen(where, error);

  const std::uint16_t chosen = acceptor.local_endpoint().port();
  const std::string url = "tcp://" + (parsed.is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(chosen);
  if (!requests) requests = std::make_shared<RequestPort>();
  std::make_shared<Acceptor>(std::move(acceptor), requests, std::move(requests_arrived), std::move(clock))->accept();
  return TcpEndpoint(std::move(requests), url);
}

}  // namespace opentmcl::server
