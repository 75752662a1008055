#pragma once

#include <cstdint>

#include "firmware/hal/hal.hpp"
#include "firmware/module/ascii_port.hpp"
#include "firmware/module/can_line.hpp"
#include "firmware/module/heartbeat.hpp"
#include "firmware/module/pausing_port.hpp"
#include "firmware/motion/axis.hpp"
#include "firmware/motion/reference_search.hpp"
#include "firmware/motion/supply_monitor.hpp"
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
  /// Does nothing yet: the first poll() brings the chips and the settings up. `extensions` and all that `hal` refers to
  /// must outlive the module.
  Module(const ModuleDescription& description, const Hal& hal, const Extensions& extensions = no_extensions);

  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  /// One turn of the main loop: takes at most one command from each port, executes at most one instruction of the
  /// program, looks after motion, current and EEPROM. Never waits.
  /// @param now never runs backwards
  /// @return when the next turn is needed if nothing happens outside (`now` or earlier: at once; `never`: only then).
  ///         Bytes on a port and changes of inputs need a turn too.
  Microseconds poll(Microseconds now) {
    // Most turns bring one byte or none: they end here.
    Microseconds lines_due = never;
    for (Line* line = lines_; line != lines_end_; ++line) {
      if (!receive(*line, now)) continue;
      const Microseconds line_due = serve(*line, now);
      if (line_due < lines_due) lines_due = line_due;
    }
    const Microseconds parts_due = now < parts_due_ ? parts_due_ : poll_parts(now);
    return parts_due < lines_due ? parts_due : lines_due;
  }

  /// For boards that see when the motor arrives at its target or leaves it and when a switch changes: turns in which a
  /// program only looks for that may be left out.
  /// @param due what the last poll() returned
  /// @return when the next turn is needed if no such change comes before; turns that are not left out come every
  ///         Executor::wait_poll_period from `due` on
  Microseconds due_without_change(Microseconds due) const {
    const Microseconds awaited = executor_.next_turn_without_change();
    if (due != executor_.next_turn() || awaited == due) return due;
    return awaited < others_due_ ? awaited : others_due_;
  }

  /// The level of an input changed, or the motor supply: the next poll() looks at all of them. A board that cannot tell
  /// calls this every 10 ms.
  void note_input_change();

  /// What a datagram came to.
  enum class Handling : std::uint8_t {
    answered,  ///< the reply is to be sent
    silent,    ///< no reply: another address, suppressed, or a command that has none
    busy,      ///< the command waits for the EEPROM: try the same datagram again on a later turn
  };

  /// Executes one datagram in direct mode. It comes from no port: it does not count for the heartbeat, and command 139
  /// is not available.
  Handling handle(const Datagram& request, hal::PortKind kind, Microseconds now, Datagram& reply);

  /// Command 255 was executed and its reply sent: the board is to restart the module as at power-on.
  bool restart_requested() const { return restart_requested_; }

  /// Baud rate of RS485 in bit/s, as global parameter 65 was when the module started: a change needs a restart. 0 until
  /// the turn that starts the module.
  std::uint32_t rs485_baud_rate() const { return rs485_baud_rate_; }

  /// What a display shows of the module.
  struct Snapshot {
    std::int32_t position;              ///< microsteps
    std::int32_t velocity;              ///< internal units
    std::int32_t microstep_resolution;  ///< axis parameter 140
    std::int32_t pulse_divisor;         ///< axis parameter 154
    ProgramMachine::Mode program;
  };

  /// Looks without a command: that would count for the heartbeat, and be stored in a program that is being downloaded.
  Snapshot snapshot();

  /// The same for a debugger: registers, flags, stack and interrupts of the program.
  const ProgramMachine& program() const { return program_machine_; }
  /// Axis parameter 207, which stays as it is.
  std::uint8_t axis_error_flags() const { return axis_.error_flags(); }

  const ModuleDescription& description() const { return description_; }

 private:
  /// A port and what has come from it: less than a datagram, or one that is to be executed.
  struct Line {
    hal::BytePort* bytes = nullptr;  ///< the port itself, `ascii` in ASCII mode, or `paused` on RS485
    hal::PortKind kind = hal::PortKind::usb;
    Framer framer;
    hal::Port port{};
    AsciiPort ascii;
    PausingPort paused;

    bool is_in_ascii_mode() const { return bytes == &ascii; }
  };
  static constexpr std::size_t maximum_lines = 5;  ///< four byte ports and CAN

  /// Where commands come from, as the heartbeats (global parameters 68 and 82) tell them apart.
  enum class Interface : std::uint8_t { serial, can };

  /// To whom a datagram is addressed.
  enum class Recipient : std::uint8_t { other, this_module, this_module_on_can, group };

  [[gnu::noinline]] bool start(Microseconds now);
  void open_lines();
  /// Takes what is missing of a datagram from a line, so at most one datagram. @return whether it is complete
  static bool receive(Line& line, Microseconds now) {
    // A datagram that waits for the EEPROM has no room left, so nothing is read behind it.
    std::uint8_t* const room = line.framer.room(now);
    return line.framer.filled(line.bytes->read(room, line.framer.missing()), now);
  }
  Microseconds poll_parts(Microseconds now) {
    // Most turns of a program only calculate: they end here.
    constexpr Microseconds at_once = 0;
    return now < others_due_ && executor_.calculate() ? at_once : poll_all(now);
  }
  // Out of line is what few turns need: inlined it would make every turn save registers for it.
  [[gnu::noinline]] Microseconds poll_all(Microseconds now);
  [[gnu::noinline]] Microseconds poll_restart(Microseconds now);
  void watch_axis(Microseconds now);
  [[gnu::noinline]] void watch_supply();
  bool is_to_start_program() const;
  [[gnu::noinline]] void note_axis_events();
  Microseconds serve(Line& line, Microseconds now);
  /// Inline, for it is called for each datagram. @param line where the datagram came from, if from a line
  [[gnu::always_inline]] Handling handle(const Datagram& request, hal::PortKind kind, Line* line, Microseconds now,
                                         Datagram& reply);
  [[gnu::noinline]] Microseconds poll_lines(Microseconds now);
  bool has_reply_to_send() const;
  void set_ascii_mode(Line& line, bool ascii);
  void report_position();
  /// A valid command for this module came.
  void note_command(Interface interface, Microseconds now) {
    heartbeats_[static_cast<std::size_t>(interface)].note(now);
  }
  bool watches_heartbeat() const {
    return (global_parameters_[GlobalParameter::serial_heartbeat] |
            global_parameters_[GlobalParameter::can_heartbeat]) != 0;
  }
  [[gnu::noinline]] Microseconds poll_heartbeats(Microseconds now);
  void hold_motor();
  /// Out of line, to keep the way of a datagram over USB short.
  [[gnu::noinline]] Recipient recipient_on_bus(std::uint8_t address, hal::PortKind kind) const;
  void write_reply(const Command& command, const Outcome& outcome, GlobalParameter own_address, Datagram& reply) const;
  std::uint8_t address_setting(GlobalParameter parameter) const {
    return static_cast<std::uint8_t>(global_parameters_[parameter]);
  }

  const ModuleDescription& description_;
  Hal hal_;
  ParameterStore store_;
  Axis axis_;
  ReferenceSearch reference_search_;
  SupplyMonitor supply_monitor_;
  AxisParameterAccess axis_parameters_;
  GlobalParameterAccess global_parameters_;
  ProgramMemory program_memory_;
  ProgramMachine program_machine_;
  Executor executor_;
  CanLine can_line_;
  Line lines_[maximum_lines];
  Line* lines_end_ = lines_;  ///< no port is read before the start
  bool started_ = false;
  Microseconds parts_due_ = 0;   ///< when poll_parts() is needed unless a command comes before
  Microseconds others_due_ = 0;  ///< when the parts other than the program need it
  bool restart_requested_ = false;
  bool has_bus_ = false;            ///< there is an RS485 line
  bool lines_need_poll_ = false;    ///< poll_lines() has something to do
  bool heartbeat_missing_ = false;  ///< the motor is held until commands come again
  Heartbeat heartbeats_[2];         ///< by Interface
  std::uint32_t rs485_baud_rate_ = 0;
  Line* mode_change_ = nullptr;  ///< the line that is to change between binary and ASCII mode when its reply is sent
  Line* report_line_ = nullptr;  ///< where command 138 came from, while a move is under way whose end is to be reported
};

}  // namespace opentmcl
