// For tests: a connection whose other end is a list of answers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "client/transport.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::client {

/// Each request of nine bytes takes the next answer from the script; time moves only while somebody waits in vain.
class ScriptedTransport final : public Transport {
 public:
  using Bytes = std::vector<std::uint8_t>;

  void answer(const Reply& reply) { answer(encode(reply)); }
  void answer(const Datagram& datagram) { script_.emplace_back(datagram.bytes, datagram.bytes + datagram_size); }
  void answer(Bytes bytes) { script_.push_back(std::move(bytes)); }
  void answer_nothing() { script_.emplace_back(); }
  void unplug() { gone_ = true; }

  const std::vector<Request>& requests() const { return requests_; }
  bool script_is_finished() const { return script_.empty(); }

  Result<void> send(std::span<const std::uint8_t> bytes) override {
    if (gone_) return gone();
    Datagram datagram;
    std::copy(bytes.begin(), bytes.end(), datagram.bytes);
    requests_.push_back(decode_request(datagram));
    if (!script_.empty()) {
      arrived_.insert(arrived_.end(), script_.front().begin(), script_.front().end());
      script_.pop_front();
    }
    return {};
  }

  /// Hands out four bytes at most, as a slow line does.
  Result<std::size_t> receive(std::span<std::uint8_t> buffer, Duration limit) override {
    if (gone_) return gone();
    const std::size_t count = std::min({buffer.size(), arrived_.size(), std::size_t{4}});
    if (count == 0) now_ += limit;
    std::copy_n(arrived_.begin(), count, buffer.begin());
    arrived_.erase(arrived_.begin(), arrived_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }

  void drain() override {}
  void pause(Duration duration) override { now_ += duration; }
  Duration now() const override { return now_; }
  const std::string& name() const override { return name_; }

 private:
  Error gone() const { return {ErrorKind::input_output, name_ + " is gone", {}}; }

  std::deque<Bytes> script_;
  std::deque<std::uint8_t> arrived_;
  std::vector<Request> requests_;
  Duration now_{0};
  bool gone_ = false;
  std::string name_ = "script";
};

}  // namespace opentmcl::client
