#include "server/farm.hpp"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <utility>

#include "server/wake_up.hpp"

namespace opentmcl::server {

namespace {

/// Between two rounds of turns; more would let those wait that are due.
constexpr int most_events_in_a_row = 64;

}  // namespace

Farm::Farm(boost::asio::io_context& events, std::size_t member_count, Options options, WallClock clock)
    : events_(events), options_(options), clock_(std::move(clock)), members_(member_count), deadlines_(member_count) {}

std::chrono::microseconds Farm::turn() const {
  return std::clamp<std::chrono::microseconds>(turn_per_member * members_.size(), shortest_turn, longest_turn);
}

std::chrono::microseconds Farm::slice() const {
  const std::size_t count = std::max<std::size_t>(members_.size(), 1);
  return std::clamp<std::chrono::microseconds>(slices_of_all / count, shortest_slice, longest_slice);
}

void Farm::set(std::size_t member, Simulated& simulated, std::vector<const RequestQueue*> requests, bool is_prompt) {
  Follower::Options options;
  options.speed = options_.speed;
  options.duration = options_.duration;
  options.turn = is_prompt ? shortest_turn : turn();
  options.slice = slice();
  members_.at(member).follower = std::make_unique<Follower>(simulated, std::move(requests), options, clock_);
}

void Farm::start() {
  is_started_ = true;
  // Begun one after the other, they are due one after the other, however alike they are.
  const std::chrono::microseconds shift = turn();
  for (std::size_t i = 0; i < members_.size(); ++i) {
    members_[i].follower->start(shift * i / members_.size());
    note_turn(i, clock_());
  }
}

void Farm::serve(std::size_t member, WallTime now) {
  if (!is_started_) return;
  members_[member].follower->serve(now);
  ++served_turns_;
  note_turn(member, now);
}

void Farm::note_turn(std::size_t member, WallTime now) {
  ++turns_;
  Follower& follower = *members_[member].follower;
  if (follower.is_finished() && !std::exchange(members_[member].is_finished, true)) ++finished_;
  // Of members that are always due the one whose turn is longest ago comes first.
  deadlines_.set(member, follower.is_finished() ? WallTime::max() : std::max(follower.next_turn(), now));
  if (after_turn_) after_turn_(member);
}

void Farm::advance(WallTime now) {
  last_round_ = now;
  is_behind_ = false;
  while (deadlines_.first_deadline() <= now) {
    const WallTime present = clock_();
    if (present - now >= longest_round) {
      is_behind_ = true;
      return;
    }
    const std::size_t member = deadlines_.first();
    members_[member].follower->advance(present);
    note_turn(member, clock_());
  }
}

WallTime Farm::next_turn() const {
  const WallTime first = deadlines_.first_deadline();
  // Those that become due within a millisecond share one awakening of the thread.
  const bool is_at_leisure = !is_behind_ && options_.speed != Pace::maximum;
  return is_at_leisure && first != WallTime::max() ? std::max(first, last_round_ + shortest_turn) : first;
}

void Farm::run() {
  const auto keep_running = boost::asio::make_work_guard(events_);
  WakeUp wake_up(events_);
  start();
  while (!stopped_ && !is_finished()) {
    const WallTime now = clock_();
    if (next_turn() <= now) {
      advance(now);
    } else {
      wake_up.no_later_than(next_turn());
      events_.run_one();
    }
    for (int i = 0; i < most_events_in_a_row && events_.poll_one() > 0; ++i) {
    }
  }
}

}  // namespace opentmcl::server
