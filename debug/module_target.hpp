#pragma once

#include "debug/target.hpp"
#include "firmware/spec/instructions.hpp"

namespace opentmcl::debug {

/// A module at the other end of a connection, real or virtual. Only commands 128 to 135 and reads are used, and time
/// goes on while the program stands: so does the motor.
///
/// Where the program is comes from global parameters 128 and 130: how command 135 packs the same is known of no real
/// module (docs/decisions/0068-where-a-program-is.md).
class ModuleTarget final : public Target {
 public:
  /// `client` must outlive this.
  ModuleTarget(client::Client& client, const ModuleDescription& module) : client_(client), module_(module) {}

  client::Client& client() override { return client_; }
  const ModuleDescription& module() const override { return module_; }
  client::Result<client::ProgramStatus> status() override;
  client::Result<client::ProgramStatus> restart() override;
  client::Result<client::ProgramStatus> step(std::uint16_t address, const Command& instruction) override;
  void rest() override;
  client::Result<void> let_run() override;
  client::Result<client::ProgramStatus> halt() override;
  client::Result<client::ProgramStatus> jump(std::uint16_t address) override;
  unsigned steps_a_slice() const override { return 1; }

 private:
  client::Result<void> control(Opcode opcode);
  client::Result<std::uint16_t> program_counter();
  client::Result<client::ProgramStatus::State> state();

  client::Client& client_;
  const ModuleDescription& module_;
};

}  // namespace opentmcl::debug
