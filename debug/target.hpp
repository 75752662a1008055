#pragma once

#include <cstdint>

#include "client/client.hpp"
#include "debug/twin_powers.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::debug {

/// A module whose program is debugged. Real: ModuleTarget, any module at the other end of a connection. In the process:
/// TwinTarget, where time stands still while the program does.
///
/// Errors of all functions: those of client::Client.
class Target {
 public:
  Target() = default;
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  virtual ~Target() = default;

  /// For commands in direct mode, which work whether the program runs or not.
  virtual client::Client& client() = 0;
  virtual const ModuleDescription& module() const = 0;

  /// Where the program is. `stopped`: it has ended, or somebody stopped it.
  virtual client::Result<client::ProgramStatus> status() = 0;

  /// The program stands before instruction 0, with everything cleared that command 131 clears. The bench of a twin
  /// begins anew, too.
  virtual client::Result<client::ProgramStatus> restart() = 0;

  /// Tries to execute one instruction. What is under way, such as a WAIT, is not over when it returns: then the program
  /// counter has not moved and the step is to be tried again, after rest().
  /// @param address of the instruction to be executed: the program counter
  /// @param instruction what stands there
  /// @return `stopped` when the program has ended there, `running` when it can go on
  virtual client::Result<client::ProgramStatus> step(std::uint16_t address, const Command& instruction) = 0;

  /// Lets a moment pass before the next look or step.
  virtual void rest() = 0;

  /// The program runs by itself until halt(); nobody sees where.
  virtual client::Result<void> let_run() = 0;
  virtual client::Result<client::ProgramStatus> halt() = 0;

  /// Sets the program counter without executing anything. Error: usage, where no command can.
  virtual client::Result<client::ProgramStatus> jump(std::uint16_t address) = 0;

  /// How many steps take so little time that nobody needs to be asked in between whether they may go on.
  virtual unsigned steps_a_slice() const = 0;

  /// On the target's own clock.
  client::Duration now() { return client().transport().now(); }

  /// What a module on a desk cannot do; nullptr if it is one.
  virtual TwinPowers* twin() { return nullptr; }
};

/// Whether stepping changes nothing but the speed, so that a program need never run unseen.
inline bool steps_like_running(Target& target) {
  return target.twin() != nullptr;
}

}  // namespace opentmcl::debug
