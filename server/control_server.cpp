#include "server/control_server.hpp"

#include <sys/stat.h>
#include <sys/un.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

namespace opentmcl::server {

namespace asio = boost::asio;
using asio::local::stream_protocol;
using boost::system::error_code;
using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// One client and its connection. Lives as long as the connection is open.
class Connection final : public ControlClient, public std::enable_shared_from_this<Connection> {
 public:
  Connection(stream_protocol::socket socket, Control& control) : socket_(std::move(socket)), control_(&control) {
    socket_.non_blocking(true);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { leave(); }

  bool is_open() const { return socket_.is_open(); }

  void read() {
    socket_.async_read_some(asio::buffer(block_),
                            [self = shared_from_this()](const error_code& error, std::size_t count) {
                              if (error) {
                                self->close();
                              } else {
                                self->take(count);
                              }
                            });
  }

  void close() {
    leave();
    error_code nothing_left_to_do;
    socket_.close(nothing_left_to_do);
    unsent_.clear();
  }

  void changed(const nlohmann::ordered_json& params) override { send(json_rpc_notification("changed", params)); }

 private:
  void leave() {
    if (control_ != nullptr) control_->forget(*this);
    control_ = nullptr;
  }

  void take(std::size_t count) {
    for (const char byte : std::span(block_).first(count)) {
      if (byte == '\n') {
        take_line(std::exchange(line_, {}));
        if (!is_open()) return;
      } else {
        line_ += byte;
      }
    }
    if (line_.size() > ControlServer::longest_request) {
      send(json_rpc_refusal({RpcError::invalid_request, "a request is at most 1 MiB long"}));
      return close();
    }
    // Who does not read the answers may not ask more either.
    is_reading_ = unsent_.empty();
    if (is_reading_) read();
  }

  void take_line(const std::string& line) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    const std::weak_ptr<Connection> weak = weak_from_this();
    take_json_rpc(
        line,
        [this](const std::string& method, const nlohmann::json& params, const RpcAnswer& answer) {
          if (control_ != nullptr) control_->call(*this, method, params, answer);
        },
        [weak](const std::string& response) {
          if (const auto self = weak.lock()) self->send(response);
        });
  }

  void send(std::string text) {
    if (!is_open()) return;
    text += '\n';
    std::size_t sent = 0;
    if (unsent_.empty()) {
      error_code error;
      sent = socket_.write_some(asio::buffer(text), error);
      // A client that has gone is noticed by the pending read.
      if (error && error != asio::error::would_block) return;
      if (sent == text.size()) return;
    }
    if (unsent_.size() + text.size() > ControlServer::longest_backlog) return cut_off();
    const bool already_waiting = !unsent_.empty();
    unsent_.append(text, sent);
    if (!already_waiting) send_rest();
  }

  /// Later: whoever sends may be in the middle of all subscriptions.
  void cut_off() {
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->close(); });
  }

  void send_rest() {
    socket_.async_wait(stream_protocol::socket::wait_write, [self = shared_from_this()](const error_code& error) {
      if (!error && self->is_open()) self->send_unsent();
    });
  }

  void send_unsent() {
    error_code error;
    const std::size_t sent = socket_.write_some(asio::buffer(unsent_), error);
    if (error && error != asio::error::would_block) return close();
    unsent_.erase(0, sent);
    if (!unsent_.empty()) return send_rest();
    if (!is_reading_) {
      is_reading_ = true;
      read();
    }
  }

  stream_protocol::socket socket_;
  Control* control_;  // nullptr when closed
  std::array<char, 4096> block_{};
  std::string line_;
  std::string unsent_;  // what the client has not made room for yet
  bool is_reading_ = true;
};

/// What tells a file from another one that has taken its name.
using FileIdentity = std::pair<dev_t, ino_t>;

std::optional<FileIdentity> identity_of(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return std::nullopt;
  return FileIdentity{status.st_dev, status.st_ino};
}

Error cannot_listen(const std::string& path, const std::string& why) {
  return {ErrorKind::input_output, "cannot listen at " + path + ": " + why, {}};
}

/// Nobody else may look at it or connect from the moment it exists.
class OnlyForTheUser {
 public:
  OnlyForTheUser() : before_(::umask(S_IRWXG | S_IRWXO | S_IXUSR)) {}
  OnlyForTheUser(const OnlyForTheUser&) = delete;
  OnlyForTheUser& operator=(const OnlyForTheUser&) = delete;
  ~OnlyForTheUser() { ::umask(before_); }

 private:
  mode_t before_;
};

/// Makes room for a socket at `path`. Somebody who listens there is not disturbed.
Result<void> remove_left_over(asio::io_context& events, const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return {};
  if (!S_ISSOCK(status.st_mode)) return cannot_listen(path, "something that is not a socket has this name");
  stream_protocol::socket probe(events);
  error_code error;
  probe.connect(stream_protocol::endpoint(path), error);
  if (!error) return cannot_listen(path, "another simulation listens there; end it or choose another path");
  if (error != asio::error::connection_refused) return cannot_listen(path, error.message());
  if (::unlink(path.c_str()) != 0) return cannot_listen(path, std::generic_category().message(errno));
  return {};
}

}  // namespace

/// Accepts clients; lives as long as an accept is pending.
class ControlServer::Listener : public std::enable_shared_from_this<Listener> {
 public:
  Listener(asio::io_context& events, std::string path, Control& control)
      : acceptor_(events), path_(std::move(path)), control_(control) {}

  Result<void> open() {
    const stream_protocol::endpoint endpoint(path_);
    error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (error) return cannot_listen(path_, error.message());
    {
      const OnlyForTheUser restriction;
      acceptor_.bind(endpoint, error);
    }
    if (error) return cannot_listen(path_, error.message());
    identity_ = identity_of(path_);
    acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) return cannot_listen(path_, error.message());
    return {};
  }

  void accept() {
    acceptor_.async_accept([self = shared_from_this()](const error_code& error, stream_protocol::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error) self->welcome(std::move(socket));
      self->accept();
    });
  }

  void close() {
    error_code nothing_left_to_do;
    acceptor_.close(nothing_left_to_do);
    if (identity_ && identity_of(path_) == identity_) ::unlink(path_.c_str());
    for (const std::weak_ptr<Connection>& client : clients_) {
      if (const auto connection = client.lock()) connection->close();
    }
  }

  const std::string& path() const { return path_; }

 private:
  void welcome(stream_protocol::socket socket) {
    std::erase_if(clients_, [](const std::weak_ptr<Connection>& client) {
      const auto connection = client.lock();
      return !connection || !connection->is_open();
    });
    if (clients_.size() >= most_clients) return;  // the socket is closed
    auto connection = std::make_shared<Connection>(std::move(socket), control_);
    connection->read();
    clients_.push_back(connection);
  }

  stream_protocol::acceptor acceptor_;
  std::string path_;
  Control& control_;
  std::optional<FileIdentity> identity_;
  std::vector<std::weak_ptr<Connection>> clients_;
};

Result<ControlServer> ControlServer::listen(asio::io_context& events, const std::string& path, Control& control) {
  if (path.size() >= sizeof sockaddr_un{}.sun_path) {
    return Error{ErrorKind::usage,
                 path + " is too long for a socket: at most " + std::to_string(sizeof sockaddr_un{}.sun_path - 1) +
                     " characters",
                 {}};
  }
  if (Result<void> removed = remove_left_over(events, path); !removed) return removed.error();
  auto listener = std::make_shared<Listener>(events, path, control);
  if (Result<void> opened = listener->open(); !opened) return opened.error();
  listener->accept();
  return ControlServer(std::move(listener));
}

ControlServer::ControlServer(std::shared_ptr<Listener> listener) : listener_(std::move(listener)) {}

ControlServer::ControlServer(ControlServer&& other) noexcept : listener_(std::move(other.listener_)) {}

ControlServer::~ControlServer() {
  if (listener_) listener_->close();
}

const std::string& ControlServer::path() const {
  return listener_->path();
}

std::string control_path_of(const std::string& link) {
  return link + ".control";
}

}  // namespace opentmcl::server
