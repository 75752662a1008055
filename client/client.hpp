#pragma once

#include <cstdint>
#include <string>

#include "client/error.hpp"
#include "client/transport.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/io_ports.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::client {

/// What command 136 says about a module.
struct FirmwareVersion {
  std::uint16_t type_number = 0;
  std::uint8_t major = 0;
  std::uint8_t minor = 0;

  /// The module whose tables fit, or nullptr for a type OpenTMCL does not know.
  const ModuleDescription* module() const;
};

/// What command 135 type 1 says about the program.
struct ProgramStatus {
  enum class State : std::uint8_t { stopped = 0, running = 1, stepping = 2, reset = 3 };

  State state = State::stopped;
  bool waiting = false;  ///< at a WAIT
  std::uint16_t program_counter = 0;
};

const char* name_of(ProgramStatus::State state);

/// Asks one module, one command at a time. Each function waits for the answer, `time_limit` at most.
///
/// Errors of all functions: refused (with the status), timeout, protocol (broken or foreign answer; the connection is
/// brought back into step before the next command), input_output (the port is gone).
class Client {
 public:
  struct Options {
    std::uint8_t address = 1;  ///< of the module; over USB any will do
    Duration time_limit = std::chrono::seconds(1);
    /// How often a read is tried in all when the answer is missing or broken. Commands that change something are sent
    /// once: the module may have executed what it did not answer.
    unsigned read_attempts = 2;
  };

  /// `transport` must outlive this.
  explicit Client(Transport& transport) : Client(transport, Options{}) {}
  Client(Transport& transport, Options options) : transport_(transport), options_(options) {}

  Transport& transport() { return transport_; }
  const Options& options() const { return options_; }

  /// The module's reply with whatever status; its checksum and the repeated opcode have been checked. The address is
  /// not: over USB a module answers with its own, whatever it was called.
  Result<Reply> exchange(const Command& command);

  /// The value of the reply; `refused` for any status but ok: a module in download mode, too, has put the
  /// command into its program instead of executing it.
  Result<std::int32_t> execute(const Command& command);

  /// The nine bytes that come back, unchecked: for the replies of commands 134 and 136 type 0, which have a form of
  /// their own.
  Result<Datagram> exchange_raw(const Command& command);

  /// @param number axis parameter 0…255
  Result<std::int32_t> axis_parameter(std::uint8_t number, std::uint8_t motor = 0);
  Result<std::int32_t> axis_parameter(AxisParameter parameter, std::uint8_t motor = 0) {
    return axis_parameter(static_cast<std::uint8_t>(parameter), motor);
  }
  Result<void> set_axis_parameter(std::uint8_t number, std::int32_t value, std::uint8_t motor = 0);
  Result<void> set_axis_parameter(AxisParameter parameter, std::int32_t value, std::uint8_t motor = 0) {
    return set_axis_parameter(static_cast<std::uint8_t>(parameter), value, motor);
  }

  /// To the EEPROM, and from there.
  Result<void> store_axis_parameter(std::uint8_t number, std::uint8_t motor = 0);
  Result<void> restore_axis_parameter(std::uint8_t number, std::uint8_t motor = 0);

  /// @param number global parameter or user variable 0…255
  Result<std::int32_t> global_parameter(std::uint8_t number, Bank bank);
  Result<void> set_global_parameter(std::uint8_t number, Bank bank, std::int32_t value);
  Result<void> store_global_parameter(std::uint8_t number, Bank bank);
  Result<void> restore_global_parameter(std::uint8_t number, Bank bank);

  /// @param velocity internal units, -2047…2047; negative turns left
  Result<void> rotate(std::int32_t velocity, std::uint8_t motor = 0);
  /// @param position microsteps
  Result<void> move_to(std::int32_t position, std::uint8_t motor = 0);
  /// @param distance microsteps from the actual position
  Result<void> move_by(std::int32_t distance, std::uint8_t motor = 0);
  /// @param coordinate 0…20, of which the module refuses those it does not have
  Result<void> move_to_coordinate(std::uint8_t coordinate, std::uint8_t motor = 0);
  Result<void> stop(std::uint8_t motor = 0);

  Result<void> start_reference_search(std::uint8_t motor = 0);
  Result<void> stop_reference_search(std::uint8_t motor = 0);
  /// 0 when no search is running, else the state of the search.
  Result<std::int32_t> reference_search_status(std::uint8_t motor = 0);

  Result<std::int32_t> input_output(std::uint8_t port, IoBank bank);
  Result<void> set_output(std::uint8_t port, IoBank bank, std::int32_t value);

  /// Stored positions, in microsteps.
  Result<std::int32_t> coordinate(std::uint8_t number, std::uint8_t motor = 0);
  Result<void> set_coordinate(std::uint8_t number, std::int32_t position, std::uint8_t motor = 0);
  Result<void> capture_coordinate(std::uint8_t number, std::uint8_t motor = 0);

  /// From the beginning, with cleared registers.
  Result<void> start_program();
  Result<void> stop_program();
  Result<ProgramStatus> program_status();
  /// The registers that the program calculates with.
  Result<std::int32_t> accumulator();
  Result<std::int32_t> x_register();

  Result<FirmwareVersion> firmware_version();
  /// As the module spells it: "1161V147".
  Result<std::string> firmware_version_text();

 private:
  Result<std::int32_t> read(const Command& command, bool repeatable);
  Result<void> change(const Command& command);
  Result<void> send(const Command& command);
  Result<Datagram> receive();
  Result<Reply> receive_reply(const Command& command);
  void resynchronise();

  Transport& transport_;
  Options options_;
  bool out_of_step_ = false;  // bytes of an answer nobody waits for may still arrive
};

}  // namespace opentmcl::client
