#pragma once

#include <cstdint>

#include "firmware/hal/hal.hpp"
#include "firmware/motion/axis.hpp"
#include "firmware/motion/reference_search.hpp"
#include "firmware/param/axis_parameter_access.hpp"
#include "firmware/param/global_parameter_access.hpp"
#include "firmware/param/parameter_store.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/tmcl/executor.hpp"
#include "firmware/tmcl/program_machine.hpp"
#include "firmware/tmcl/program_memory.hpp"
#include "firmware/wire/framer.hpp"

namespace opentmcl {

/// One TMCL module: everything above the board. It owns no global state, so as many as wanted live in one process.
class Module {
 public:
  /// Does nothing yet: the first poll() brings the chips and the settings up. `hal` and what it refers to must outlive
  /// the module.
  Module(const ModuleDescription& description, const Hal& hal);

  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  /// One turn of the main loop: takes at most one command from each port, executes at most one instruction of the
  /// program, looks after motion, current and EEPROM. Never waits.
  /// @param now never runs backwards
  /// @return when the next turn is needed if nothing happens outside (`now` or earlier: at once; `never`: only then).
  ///         Bytes on a port and changes of inputs need a turn too.
  Microseconds poll(Microseconds now);

  /// What a datagram came to.
  enum class Handling : std::uint8_t {
    answered,  ///< the reply is to be sent
    silent,    ///< no reply: another address, suppressed, or a command that has none
    busy,      ///< the command waits for the EEPROM: try the same datagram again on a later turn
  };

  /// Executes one datagram in direct mode.
  Handling handle(const Datagram& request, hal::PortKind kind, Microseconds now, Datagram& reply);

  /// Command 255 was executed and its reply sent: the board is to restart the module as at power-on.
  bool restart_requested() const { return restart_requested_; }

  const ModuleDescription& description() const { return description_; }

 private:
  /// Bytes that were read from a port and not looked at yet wait here, behind at most one datagram.
  struct PortState {
    Framer framer;
    bool is_waiting = false;  ///< framer.datagram() is complete and was answered "busy" so far
    std::uint8_t received[2 * datagram_size] = {};
    std::uint8_t received_count = 0;
    std::uint8_t received_next = 0;
  };
  static constexpr std::uint8_t maximum_ports = 4;

  /// To whom a datagram is addressed.
  enum class Recipient : std::uint8_t { other, this_module, group };

  bool start(Microseconds now);
  Microseconds poll_port(std::uint8_t index, Microseconds now);
  bool receive(std::uint8_t index, Microseconds now);
  void serve(std::uint8_t index, Microseconds now);
  void report_position();
  Recipient recipient_of(std::uint8_t address, hal::PortKind kind) const;
  Datagram reply_to(const Command& command, const Outcome& outcome) const;
  std::uint8_t address_setting(GlobalParameter parameter) const {
    return static_cast<std::uint8_t>(global_parameters_[parameter]);
  }

  const ModuleDescription& description_;
  Hal hal_;
  ParameterStore store_;
  Axis axis_;
  ReferenceSearch reference_search_;
  AxisParameterAccess axis_parameters_;
  GlobalParameterAccess global_parameters_;
  ProgramMemory program_memory_;
  ProgramMachine program_machine_;
  Executor executor_;
  PortState ports_[maximum_ports];
  bool started_ = false;
  bool restart_requested_ = false;
  std::uint8_t report_port_ = 0;  ///< the port command 138 came from
  bool report_is_due_ = false;    ///< a move is under way whose end is to be reported
};

}  // namespace opentmcl
