// Which subroutines are open, found out by watching a program step by step: no command shows the stack of a module.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::debug {

/// Whether another instruction than the following one may come after it.
bool can_jump(Opcode opcode);
/// Whether it may open a subroutine.
bool can_call(Opcode opcode);

/// A subroutine or an interrupt routine that was entered and not left.
struct OpenRoutine {
  std::uint16_t return_address = 0;
  bool is_interrupt = false;

  friend constexpr bool operator==(const OpenRoutine&, const OpenRoutine&) = default;
};

class CallStack {
 public:
  /// @param commands of the program: where its interrupt routines begin it says itself (VECT)
  explicit CallStack(const std::vector<Command>& commands);

  /// Nothing is open: the program begins.
  void reset();
  /// Nobody knows what is open.
  void forget();

  /// The program went from `before`, where `command` stands, to `after`. A step that is no way of `command` has entered
  /// an interrupt routine and executed its first instruction.
  void note(std::uint16_t before, const Command& command, std::uint16_t after);

  /// The outermost first; below them may be others if not is_whole().
  const std::vector<OpenRoutine>& routines() const { return routines_; }
  bool is_whole() const { return whole_; }
  /// Rises with every routine that is entered, falls with every one that is left, be it known or not.
  std::int64_t level() const { return level_; }

 private:
  bool is_way(const Command& command, std::uint16_t before, std::uint16_t after) const;
  void follow(const Command& command, std::uint16_t before, std::uint16_t after);
  void enter(OpenRoutine routine);
  void leave(bool interrupt);
  std::size_t open_subroutines() const;

  const std::vector<Command>& commands_;
  std::vector<std::uint16_t> vectors_;
  std::vector<OpenRoutine> routines_;
  std::int64_t level_ = 0;
  bool whole_ = false;
};

}  // namespace opentmcl::debug
