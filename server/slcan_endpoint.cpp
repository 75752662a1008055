#include "server/slcan_endpoint.hpp"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <utility>

#include "server/pty.hpp"
#include "server/slcan_channel.hpp"

namespace opentmcl::server {

namespace asio = boost::asio;

namespace {

/// Moves the bytes between a pseudo terminal and a channel; lives as long as the terminal is open.
class SlcanLine final : public std::enable_shared_from_this<SlcanLine> {
 public:
  using Stream = asio::posix::basic_stream_descriptor<asio::io_context::executor_type>;

  SlcanLine(Stream stream, std::shared_ptr<CanBus> bus, RequestsArrived requests_arrived, WallClock clock)
      : stream_(std::move(stream)),
        bus_(std::move(bus)),
        requests_arrived_(std::move(requests_arrived)),
        clock_(clock),
        channel_(
            *bus_, [this](std::string_view text) { write(text); }, std::move(clock)) {
    stream_.non_blocking(true);
  }

  void read() {
    is_reading_ = true;
    stream_.async_wait(Stream::wait_read, [self = shared_from_this()](const boost::system::error_code& error) {
      if (!error) self->take();
    });
  }

 private:
  /// More than the longest line; who sends more lets others have their turn first.
  static constexpr std::size_t bytes_per_turn = 1024;
  /// What a host that does not read costs at most; frames for it are lost then, as an adapter's memory is small too.
  static constexpr std::size_t most_unsent = 16'384;

  void take() {
    std::array<std::uint8_t, bytes_per_turn> received;  // NOLINT(cppcoreguidelines-pro-type-member-init): read into
    boost::system::error_code error;
    const std::size_t count = stream_.read_some(asio::buffer(received), error);
    is_reading_ = false;
    if (error && error != asio::error::would_block) return;
    if (count > 0 && channel_.take(std::span(received).first(count))) requests_arrived_(clock_());
    // A host that does not read what it is sent may not send more either.
    read_unless_reading();
  }

  void read_unless_reading() {
    if (unsent_.empty() && !is_reading_) read();
  }

  void write(std::string_view text) {
    const bool already_waiting = !unsent_.empty();
    if (unsent_.size() + text.size() > most_unsent) return;
    if (!already_waiting) {
      boost::system::error_code error;
      const std::size_t sent = stream_.write_some(asio::buffer(text), error);
      if (error && error != asio::error::would_block) return;
      text.remove_prefix(sent);
    }
    unsent_ += text;
    if (!unsent_.empty() && !already_waiting) write_rest();
  }

  void write_rest() {
    stream_.async_wait(Stream::wait_write, [self = shared_from_this()](const boost::system::error_code& error) {
      if (!error) self->write_unsent();
    });
  }

  void write_unsent() {
    boost::system::error_code error;
    const std::size_t sent = stream_.write_some(asio::buffer(unsent_), error);
    if (error && error != asio::error::would_block) return;
    unsent_.erase(0, sent);
    if (!unsent_.empty()) {
      write_rest();
    } else {
      read_unless_reading();
    }
  }

  Stream stream_;
  std::shared_ptr<CanBus> bus_;
  RequestsArrived requests_arrived_;
  WallClock clock_;
  bool is_reading_ = false;
  std::string unsent_;  // what the host has not made room for yet
  SlcanChannel channel_;
};

}  // namespace

client::Result<SlcanEndpoint> SlcanEndpoint::open(asio::io_context& events, std::shared_ptr<CanBus> bus,
                                                  RequestsArrived requests_arrived, WallClock clock) {
  client::Result<Pty> pty = Pty::open();
  if (!pty) return pty.error();
  std::make_shared<SlcanLine>(SlcanLine::Stream(events, pty->own_side.release()), std::move(bus),
                              std::move(requests_arrived), std::move(clock))
      ->read();
  return SlcanEndpoint(std::move(pty->terminal), pty->path);
}

}  // namespace opentmcl::server
