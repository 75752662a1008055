#pragma once

#include <optional>

#include "apps/tmcl/motion_state.hpp"
#include "server/memory_line.hpp"

namespace opentmcl::app {

/// Asks a virtual module for its state the way any host does, at a port of its own and without waiting for the answers.
class LiveLine {
 public:
  explicit LiveLine(server::MemoryLine& line) : line_(line) {}

  /// Sends the questions, unless earlier ones are still unanswered.
  void ask();

  /// The state, when all questions have been answered.
  std::optional<MotionState> take_answers();

 private:
  server::MemoryLine& line_;
  bool asked_ = false;
};

}  // namespace opentmcl::app
