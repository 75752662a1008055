#include "debug/call_stack.hpp"

#include <algorithm>

namespace opentmcl::debug {

bool can_call(Opcode opcode) {
  return opcode == Opcode::csub || opcode == Opcode::call;
}

bool can_jump(Opcode opcode) {
  switch (opcode) {
    case Opcode::ja:
    case Opcode::jc:
    case Opcode::csub:
    case Opcode::call:
    case Opcode::djnz:
    case Opcode::rst:
    case Opcode::rsub:
    case Opcode::reti:
      return true;
    default:
      return false;
  }
}

CallStack::CallStack(const std::vector<Command>& commands) : commands_(commands) {
  for (const Command& command : commands) {
    if (static_cast<Opcode>(command.opcode) != Opcode::vect) continue;
    const auto vector = static_cast<std::uint16_t>(command.value);
    if (vector < commands.size()) vectors_.push_back(vector);
  }
}

void CallStack::reset() {
  routines_.clear();
  level_ = 0;
  whole_ = true;
}

void CallStack::forget() {
  routines_.clear();
  level_ = 0;
  whole_ = false;
}

std::size_t CallStack::open_subroutines() const {
  return static_cast<std::size_t>(
      std::count_if(routines_.begin(), routines_.end(), [](const auto& routine) { return !routine.is_interrupt; }));
}

/// Whether `after` can come after `command` at `before`.
bool CallStack::is_way(const Command& command, std::uint16_t before, std::uint16_t after) const {
  const bool goes_on = after == before + 1;
  const bool jumps = after == static_cast<std::uint16_t>(command.value);
  switch (static_cast<Opcode>(command.opcode)) {
    case Opcode::ja:
    case Opcode::rst:
      return jumps;
    case Opcode::jc:
    case Opcode::djnz:
    case Opcode::call:
    case Opcode::csub:
      return jumps || goes_on;
    case Opcode::rsub: {
      if (goes_on || !whole_) return true;
      const auto innermost =
          std::find_if(routines_.rbegin(), routines_.rend(), [](const auto& r) { return !r.is_interrupt; });
      return innermost != routines_.rend() && innermost->return_address == after;
    }
    case Opcode::reti:
      return true;
    default:
      return goes_on || after == before;
  }
}

void CallStack::note(std::uint16_t before, const Command& command, std::uint16_t after) {
  if (is_way(command, before, after)) return follow(command, before, after);
  for (const std::uint16_t vector : vectors_) {
    if (!is_way(commands_[vector], vector, after)) continue;
    enter({before, true});
    return follow(commands_[vector], vector, after);
  }
  // Somebody else moved the program.
  forget();
}

void CallStack::follow(const Command& command, std::uint16_t before, std::uint16_t after) {
  const auto opcode = static_cast<Opcode>(command.opcode);
  const auto next = static_cast<std::uint16_t>(before + 1);
  if (can_call(opcode)) {
    // Ignored when the stack is full, and by CALL when its condition does not hold.
    const bool called = after != next || (opcode == Opcode::csub && command.value == next);
    if (called && open_subroutines() < maximum_open_calls) enter({next, false});
  } else if (opcode == Opcode::rsub) {
    const bool is_ignored = whole_ && open_subroutines() == 0;
    if (!is_ignored && (after != next || open_subroutines() > 0)) leave(false);
  } else if (opcode == Opcode::reti) {
    const bool is_open =
        std::any_of(routines_.begin(), routines_.end(), [](const auto& routine) { return routine.is_interrupt; });
    if (is_open || (!whole_ && after != next)) leave(true);
  } else if (opcode == Opcode::rst) {
    const std::int64_t outermost = level_ - static_cast<std::int64_t>(routines_.size());
    routines_.clear();
    level_ = outermost - (whole_ ? 0 : 1);
    whole_ = true;
  }
}

void CallStack::enter(OpenRoutine routine) {
  routines_.push_back(routine);
  ++level_;
}

/// The innermost of its kind: subroutines and interrupts do not share a stack.
void CallStack::leave(bool interrupt) {
  --level_;
  const auto innermost = std::find_if(routines_.rbegin(), routines_.rend(),
                                      [interrupt](const auto& routine) { return routine.is_interrupt == interrupt; });
  if (innermost != routines_.rend()) routines_.erase(std::next(innermost).base());
}

}  // namespace opentmcl::debug
