#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "server/pace.hpp"

namespace opentmcl::server {

/// Which of many members is due first. A binary heap that knows where each member is, so that a deadline can be
/// changed; members that wait for nothing sink to the bottom and cost nothing.
class DeadlineHeap {
 public:
  /// Members 0 to `count` - 1, none of which is due.
  explicit DeadlineHeap(std::size_t count) : deadlines_(count, WallTime::max()), places_(count), members_(count) {
    for (std::size_t i = 0; i < count; ++i) places_[i] = members_[i] = i;
  }

  /// @pre there is a member
  std::size_t first() const { return members_.front(); }
  /// Of the first; WallTime::max() when nobody is due.
  WallTime first_deadline() const { return members_.empty() ? WallTime::max() : deadlines_[members_.front()]; }

  void set(std::size_t member, WallTime deadline) {
    deadlines_[member] = deadline;
    sink(rise(places_[member]));
  }

 private:
  WallTime deadline_at(std::size_t place) const { return deadlines_[members_[place]]; }

  void exchange(std::size_t one, std::size_t other) {
    std::swap(members_[one], members_[other]);
    places_[members_[one]] = one;
    places_[members_[other]] = other;
  }

  std::size_t rise(std::size_t place) {
    while (place > 0) {
      const std::size_t parent = (place - 1) / 2;
      if (deadline_at(parent) <= deadline_at(place)) break;
      exchange(place, parent);
      place = parent;
    }
    return place;
  }

  void sink(std::size_t place) {
    while (true) {
      std::size_t earliest = place;
      for (std::size_t child = 2 * place + 1; child <= 2 * place + 2 && child < members_.size(); ++child) {
        if (deadline_at(child) < deadline_at(earliest)) earliest = child;
      }
      if (earliest == place) return;
      exchange(place, earliest);
      place = earliest;
    }
  }

  std::vector<WallTime> deadlines_;   // by member
  std::vector<std::size_t> places_;   // by member
  std::vector<std::size_t> members_;  // by place
};

}  // namespace opentmcl::server
