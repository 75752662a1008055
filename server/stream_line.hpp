#pragma once

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
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
    is_reading_ = true;
    stream_.async_wait(Stream::wait_read, [self = this->shared_from_this()](const boost::system::error_code& error) {
      if (error) {
        self->close();
      } else {
        self->take();
      }
    });
  }

  void close() {
    boost::system::error_code nothing_left_to_do;
    stream_.close(nothing_left_to_do);
    port_->forget(*this);
    is_waiting_for_room_ = false;
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

  void room_again() override {
    is_waiting_for_room_ = false;
    read_if_there_is_room();
  }

 private:
  /// More than a hundred requests.
  static constexpr std::size_t bytes_per_turn = 1024;

  void take() {
    // On the stack, for most lines are silent at most times. Whoever sends more than fits has to let others have their
    // turn before the rest is read.
    std::array<std::uint8_t, bytes_per_turn> received;  // NOLINT(cppcoreguidelines-pro-type-member-init): read into
    boost::system::error_code error;
    const std::size_t count = stream_.read_some(boost::asio::buffer(received), error);
    is_reading_ = false;
    if (error && error != boost::asio::error::would_block) {
      close();
      return;
    }
    if (count > 0) pass_on({received.data(), count});
    read_if_there_is_room();
  }

  void pass_on(std::span<const std::uint8_t> bytes) {
    // Half a request is forgotten after 5 ms of silence on the wall clock, as the host sees it.
    const WallTime wall = clock_();
    const auto now = static_cast<Microseconds>(
        std::chrono::duration_cast<std::chrono::microseconds>((wall - not_listened_).time_since_epoch()).count());
    if (cutter_.take(bytes, now, *port_, *this)) {
      requests_arrived_(wall);
      if (cutter_.take_rest(*port_, *this)) requests_arrived_(wall);
    }
  }

  /// A host that does not read its replies may not send more either.
  void read_if_there_is_room() {
    if (is_reading_ || !stream_.is_open()) return;
    const bool is_free = unsent_.empty() && !is_waiting_for_room_;
    if (is_free && !port_->is_full()) {
      // What came meanwhile was no silence of the host.
      if (deaf_since_) not_listened_ += clock_() - *std::exchange(deaf_since_, std::nullopt);
      read();
      return;
    }
    if (!deaf_since_) deaf_since_ = clock_();
    if (!is_free) return;
    is_waiting_for_room_ = true;
    port_->wait_for_room(*this);
    watch();
  }

  /// Keeps this alive, and notices a host that is gone, while nothing is read.
  void watch() {
    if (is_watched_) return;
    is_watched_ = true;
    stream_.async_wait(Stream::wait_error, [self = this->shared_from_this()](const boost::system::error_code& error) {
      self->is_watched_ = false;
      if (!error) self->close();
    });
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
    unsent_.shrink_to_fit();
    read_if_there_is_room();
  }

  Stream stream_;
  std::shared_ptr<RequestPort> port_;
  RequestsArrived requests_arrived_;
  WallClock clock_;
  RequestCutter cutter_;
  std::vector<std::uint8_t> unsent_;    // replies the host has not made room for yet
  std::optional<WallTime> deaf_since_;  // when reading stopped because there was no room
  WallTime::duration not_listened_{0};  // how long that has been in all
  bool is_reading_ = false;
  bool is_waiting_for_room_ = false;
  bool is_watched_ = false;
};

}  // namespace opentmcl::server
