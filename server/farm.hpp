#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "server/deadline_heap.hpp"
#include "server/follower.hpp"

namespace boost::asio {
class io_context;
}

namespace opentmcl::server {

/// Many modules in one thread, each following the wall clock for itself: whoever is due next has its turn, and who
/// waits for commands costs nothing. A member is a module, or several on one line.
///
/// No member can disturb the others: a turn of a member that has much to simulate ends after a slice, between turns the
/// event loop is looked at, and each host's line is read in small pieces (docs/decisions/0051-turns-of-a-farm.md).
class Farm {
 public:
  struct Options {
    double speed = 1;  ///< more than 0, or Pace::maximum
    /// Simulated time of each member after which run() returns.
    std::optional<Microseconds> duration = {};
  };

  /// What one turn of a member may take of the thread's time, and all turns in a row before hosts are heard again. The
  /// more members there are, the less: when the computer had no time for the farm all of them are late at once, and
  /// requests must not wait until each has caught up.
  static constexpr std::chrono::microseconds longest_slice{500};
  static constexpr std::chrono::microseconds shortest_slice{50};
  static constexpr std::chrono::milliseconds slices_of_all{100};
  static constexpr std::chrono::milliseconds longest_round{1};
  /// A turn is this long for each member there is, but within these limits: 100 members have one each millisecond,
  /// 2000 and more each twenty. Requests are answered at once all the same; only what a module says of its own, the
  /// second reply of command 138, comes so much late. A turn of 20 ms costs little more than one of 10 ms, for most of
  /// it goes into fetching a module from memory.
  static constexpr std::chrono::microseconds turn_per_member{10};
  static constexpr std::chrono::milliseconds shortest_turn{1};
  static constexpr std::chrono::milliseconds longest_turn{20};

  /// @param member_count each of them is to be set before the farm starts
  Farm(boost::asio::io_context& events, std::size_t member_count, Options options,
       WallClock clock = std::chrono::steady_clock::now);

  /// @param requests those of each port of the member; both must outlive this
  /// @param is_prompt it sends at times of its own and to the millisecond: its turns are as short as they can be
  void set(std::size_t member, Simulated& simulated, std::vector<const RequestQueue*> requests, bool is_prompt = false);

  std::size_t size() const { return members_.size(); }

  /// Handles events and lets time pass until stop() or until all members have reached the end of the duration.
  void run();
  /// From within an event handler: run() returns after this turn.
  void stop() { stopped_ = true; }

  /// Called whenever a member had its turn.
  void after_turn(std::function<void(std::size_t member)> callback) { after_turn_ = std::move(callback); }

  // ---- The parts of run(), for callers with an event loop of their own

  void start();
  /// A port of the member has new requests. Does nothing before the start.
  void serve(std::size_t member, WallTime now);
  /// Lets members that are due have their turn, at most for `longest_round`.
  void advance(WallTime now);
  /// When advance() is next needed; WallTime::max() when only an event can change anything.
  WallTime next_turn() const;
  bool is_finished() const { return finished_ == members_.size(); }

  /// Turns that members have had, requested ones among them.
  std::uint64_t turns() const { return turns_; }
  std::uint64_t served_turns() const { return served_turns_; }

 private:
  struct Member {
    std::unique_ptr<Follower> follower;
    bool is_finished = false;
  };

  std::chrono::microseconds turn() const;
  std::chrono::microseconds slice() const;
  void note_turn(std::size_t member, WallTime now);

  boost::asio::io_context& events_;
  Options options_;
  WallClock clock_;
  std::vector<Member> members_;
  DeadlineHeap deadlines_;
  std::function<void(std::size_t)> after_turn_;
  WallTime last_round_{};
  bool is_behind_ = false;  ///< the last round ended before all that were due had their turn
  bool is_started_ = false;
  bool stopped_ = false;
  std::size_t finished_ = 0;
  std::uint64_t turns_ = 0;
  std::uint64_t served_turns_ = 0;
};

}  // namespace opentmcl::server
