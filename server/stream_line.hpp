#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "server/pace.hpp"
#include "server/request_cutter.hpp"
#include "server/request_port.hpp"

namespace opentmcl::server {

/// One stream of bytes with a host at its other end: cuts it into requests for a port and sends the replies back in the
/// same turn of the event loop. Lives as long as the stream is open.
/// @tparam Stream boost::asio::posix::basic_stream_descriptor or boost::asio::ip::tcp::socket
template <class Stream>
class StreamLine final : public ReplySink, public std::enable_shared_from_this<StreamLine<Stream>> {
 public:
  /// @param requests_arrived called when the port has new requests
  StreamLine(Stream stream, std::shared_ptr<RequestPort> port, RequestsArrived requests_arrived, WallClock clock)
      : stream_(std::move(stream)),
        port_(std::move(port)),
        requests_arrived_(std::move(requests_arrived)),
        clock_(std::move(clock)) {
    stream_.non_blocking(true);
  }
  StreamLine(const StreamLine&) = delete;
  StreamLine& operator=(const StreamLine&) = delete;
  ~StreamLine() { port_->forget(*this); }

  /// Reads until the stream ends.
  void read() {
    stream_.async_read_some(
        boost::asio::buffer(received_),
        [self = this->shared_from_this()](const boost::system::error_code& error, std::size_t count) {
          if (error) {
            self->close();
          } else {
            self->take(count);
          }
        });
  }

  void close() {
    boost::system::error_code nothing_left_to_do;
    stream_.close(nothing_left_to_do);
    port_->forget(*this);
  }

  void reply(std::span<const std::uint8_t> bytes) override {
    if (unsent_.empty()) {
      boost::system::error_code error;
      const std::size_t sent = stream_.write_some(boost::asio::buffer(bytes.data(), bytes.size()), error);
      // A host that has gone is noticed by the pending read.
      if (error && error != boost::asio::error::would_block) return;
      bytes = bytes.subspan(sent);
    }
    if (bytes.empty()) return;
    const bool already_waiting = !unsent_.empty();
    unsent_.insert(unsent_.end(), bytes.begin(), bytes.end());
    if (!already_waiting) send_rest();
  }

 private:
  void take(std::size_t count) {
    // Half a request is forgotten after 5 ms of silence on the wall clock, as the host sees it.
    const WallTime wall = clock_();
    const auto now = static_cast<Microseconds>(
        std::chrono::duration_cast<std::chrono::microseconds>(wall.time_since_epoch()).count());
    if (cutter_.take({received_.data(), count}, now, *port_, *this)) {
      requests_arrived_(wall);
      if (cutter_.take_rest(*port_, *this)) requests_arrived_(wall);
    }
    // A host that does not read its replies may not send more either.
    if (unsent_.empty()) {
      read();
    } else {
      reading_ = false;
    }
  }

  void send_rest() {
    stream_.async_wait(Stream::wait_write, [self = this->shared_from_this()](const boost::system::error_code& error) {
      if (!error) self->send_unsent();
    });
  }

  void send_unsent() {
    boost::system::error_code error;
    const std::size_t sent = stream_.write_some(boost::asio::buffer(unsent_), error);
    if (error && error != boost::asio::error::would_block) return;
    unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(sent));
    if (!unsent_.empty()) {
      send_rest();
      return;
    }
    if (!reading_) {
      reading_ = true;
      read();
    }
  }

  Stream stream_;
  std::shared_ptr<RequestPort> port_;
  RequestsArrived requests_arrived_;
  WallClock clock_;
  RequestCutter cutter_;
  std::array<std::uint8_t, 4096> received_{};
  std::vector<std::uint8_t> unsent_;  // replies the host has not made room for yet
  bool reading_ = true;
};

}  // namespace opentmcl::server
