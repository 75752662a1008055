#pragma once

#include <boost/asio/steady_timer.hpp>

#include "server/pace.hpp"

namespace opentmcl::server {

/// Ends the event loop's sleep at a given time. To set a timer costs the operating system more than the whole answer to
/// a request, and every request puts the next turn off a little. So a timer that is set for too early stays; who is
/// woken by it asks again.
class WakeUp {
 public:
  explicit WakeUp(boost::asio::io_context& events) : timer_(events) {}

  void no_later_than(WallTime time) {
    if (time >= set_for_) return;
    set_for_ = time;
    timer_.expires_at(time);
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) set_for_ = WallTime::max();
    });
  }

 private:
  boost::asio::steady_timer timer_;
  WallTime set_for_ = WallTime::max();  // max() while it is not set
};

}  // namespace opentmcl::server
