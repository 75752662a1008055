#include "firmware/module/module.hpp"

namespace opentmcl {

Module::Module(const ModuleDescription& description, const Hal& hal, const Extensions& extensions)
    : description_(description),
      hal_(hal),
      store_(hal.eeprom, description),
      axis_(description.id, hal),
      reference_search_(axis_, hal.pins),
      supply_monitor_(hal.analog),
      axis_parameters_(description.id, axis_, store_, hal.pins),
      global_parameters_(description, axis_, store_),
      program_memory_(hal.eeprom, store_, description),
      executor_({description, axis_, reference_search_, axis_parameters_, global_parameters_, program_machine_,
                 program_memory_, store_, hal.pins, hal.analog, extensions}),
      can_line_(hal.can, global_parameters_) {}

/// Brings everything up, as soon as a page write that a restart interrupted is over. @return whether it is done
bool Module::start(Microseconds now) {
  if (hal_.eeprom.busy()) return false;
  store_.load();
  global_parameters_.load_stored();
  const bool has_magic =
      global_parameters_.check(static_cast<std::uint8_t>(GlobalParameter::eeprom_magic), Access::r) == Status::ok;
  constexpr std::int32_t magic =
      global_parameters[row_of(GlobalParameter::eeprom_magic)].in(ModuleId::tmcm1110).default_value;
  if (has_magic && global_parameters_[GlobalParameter::eeprom_magic] != magic) {
    // Global parameter 64 was changed to ask for this.
    if (global_parameters_.hides_program()) {
      executor_.restore_factory_settings();
    } else {
      store_.restore_factory_settings();
      global_parameters_.restore_defaults();
    }
  }
  axis_parameters_.load_stored();
  axis_.initialise(global_parameters_.wiring());
  executor_.set_outputs(Executor::power_on_outputs);
  executor_.reset_tick_timer(now);
  if (is_to_start_program()) program_machine_.run_from(0);
  watch_supply();
  open_lines();
  rs485_baud_rate_ = rs485_baud_rates[global_parameters_[GlobalParameter::rs485_baud_rate]];
  note_command(Interface::serial, now);
  note_command(Interface::can, now);
  return true;
}

void Module::open_lines() {
  const bool starts_in_ascii_mode = (global_parameters_[GlobalParameter::ascii_mode] & start_in_ascii_mode) != 0;
  for (std::uint8_t index = 0; index < hal_.port_count; ++index) {
    Line& line = *lines_end_++;
    line.port = hal_.ports[index];
    line.kind = line.port.kind;
    set_ascii_mode(line, starts_in_ascii_mode && line.kind != hal::PortKind::rs485);
    if (line.kind == hal::PortKind::rs485) {
      line.paused.begin(*line.port.bytes, global_parameters_);
      line.bytes = &line.paused;
      has_bus_ = true;
      lines_need_poll_ = true;
    }
  }
  if (hal_.can != nullptr && has_can(description_.id)) {
    can_line_.join();
    Line& line = *lines_end_++;
    line.kind = hal::PortKind::can;
    line.bytes = &can_line_;
  }
}

bool Module::is_to_start_program() const {
  return global_parameters_[GlobalParameter::auto_start] != 0 && program_memory_.is_complete();
}

/// Source: PD-1161 manual, firmware history V1.35 and V1.38; docs/decisions/0026-under-voltage.md.
void Module::watch_supply() {
  switch (supply_monitor_.look()) {
    case SupplyMonitor::Change::none:
      break;
    case SupplyMonitor::Change::failed:
      reference_search_.yield_motor();
      axis_.lock();
      executor_.note_supply_failure();
      break;
    case SupplyMonitor::Change::returned:
      axis_.unlock(global_parameters_.wiring());
      executor_.note_supply_return(is_to_start_program());
      break;
  }
}

/// While the motor moves every 10 ms or faster, otherwise when there is a reason.
void Module::watch_axis(Microseconds now) {
  if (axis_.is_look_due(now)) watch_supply();
  axis_.poll(now);
  if (axis_.has_events()) note_axis_events();
}

void Module::note_input_change() {
  axis_.look_again();
  parts_due_ = 0;
  others_due_ = 0;
}

/// The axis stopped the motor, or cannot move it on.
void Module::note_axis_events() {
  const std::uint8_t events = axis_.take_events();
  constexpr std::uint8_t stops =
      static_cast<std::uint8_t>(AxisEvent::stall) | static_cast<std::uint8_t>(AxisEvent::deviation);
  if ((events & stops) != 0) reference_search_.yield_motor();
  executor_.note_axis_events(events);
}

/// Everything but the ports. @return when it is needed again
Microseconds Module::poll_all(Microseconds now) {
  if (!started_) {
    started_ = start(now);
    if (!started_) return now + ParameterStore::poll_period;
  }
  executor_.poll(now);
  Microseconds next = never;
  const auto needs = [&next](Microseconds time) {
    if (time < next) next = time;
  };
  needs(reference_search_.poll(now));
  // Between those that start motion and the axis, which then forgets that motion was started.
  if (watches_heartbeat()) needs(poll_heartbeats(now));
  if (axis_.is_due(now)) watch_axis(now);
  needs(axis_.due());
  // Nothing that lifts the protection of a program may be written before the program is gone.
  needs(program_memory_.is_erasing() ? program_memory_.poll(now) : store_.poll(now));
  if (lines_need_poll_) needs(poll_lines(now));
  if (executor_.wants_restart()) needs(poll_restart(now));
  if (!program_machine_.is_running()) {
    parts_due_ = next;
    return next;
  }
  others_due_ = next;
  // A program may wait for an input, and any turn may be the one that sees it.
  parts_due_ = now;
  needs(executor_.next_turn());
  return next;
}

/// Lets the module restart when all is written and sent. @return when it is needed again
Microseconds Module::poll_restart(Microseconds now) {
  if (program_memory_.is_erasing() || !store_.is_written() || hal_.eeprom.busy() || has_reply_to_send()) {
    return now + ParameterStore::poll_period;
  }
  if (executor_.take_factory_reset()) {
    store_.restore_factory_settings();
    return now;
  }
  restart_requested_ = true;
  return never;
}

/// Executes the datagram that is complete on a line. @return when the line needs the next turn
Microseconds Module::serve(Line& line, Microseconds now) {
  Datagram reply;
  const Handling handling = handle(line.framer.datagram(), line.kind, &line, now, reply);
  if (handling == Handling::busy) return now + ParameterStore::poll_period;
  line.framer.reset();
  if (handling == Handling::answered) line.bytes->write(reply.bytes, datagram_size);
  if (executor_.take_reported_move()) {
    report_line_ = &line;
    lines_need_poll_ = true;
  }
  // There may be more where this came from.
  return now;
}

/// What lines need now and then: telegram pauses, changes of mode, the second reply of command 138. @return when it
/// is needed again
Microseconds Module::poll_lines(Microseconds now) {
  if (mode_change_ != nullptr) {
    set_ascii_mode(*mode_change_, !mode_change_->is_in_ascii_mode());
    mode_change_ = nullptr;
  }
  Microseconds next = never;
  if (report_line_ != nullptr) {
    report_position();
    next = now + one_millisecond;
  }
  for (Line* line = lines_; line != lines_end_; ++line) {
    const Microseconds due = line->paused.poll(now);
    if (due < next) next = due;
  }
  lines_need_poll_ = has_bus_ || report_line_ != nullptr;
  return next;
}

bool Module::has_reply_to_send() const {
  for (const Line* line = lines_; line != lines_end_; ++line) {
    if (line->paused.has_reply()) return true;
  }
  return false;
}

void Module::set_ascii_mode(Line& line, bool ascii) {
  if (ascii) {
    line.ascii.begin(line.port, global_parameters_);
    line.bytes = &line.ascii;
  } else {
    line.bytes = line.port.bytes;
  }
  line.port.bytes->set_text_mode(ascii);
}

/// While no command comes for longer than a heartbeat allows the motor is stopped, whatever a program or a reference
/// search makes of it (docs/decisions/0018-heartbeat.md). @return when it must be called again
Microseconds Module::poll_heartbeats(Microseconds now) {
  const std::int32_t serial = global_parameters_[GlobalParameter::serial_heartbeat];
  const std::int32_t can = global_parameters_[GlobalParameter::can_heartbeat];
  const Heartbeat& serial_heartbeat = heartbeats_[static_cast<std::size_t>(Interface::serial)];
  const Heartbeat& can_heartbeat = heartbeats_[static_cast<std::size_t>(Interface::can)];
  if (serial_heartbeat.is_missing(now, serial) || can_heartbeat.is_missing(now, can)) {
    hold_motor();
    heartbeat_missing_ = true;
    return never;
  }
  heartbeat_missing_ = false;
  const Microseconds serial_due = serial_heartbeat.due(serial);
  const Microseconds can_due = can_heartbeat.due(can);
  return serial_due < can_due ? serial_due : can_due;
}

/// Stops the motor when commands have just stopped coming, and whatever has started it since.
void Module::hold_motor() {
  const bool was_started = axis_.is_awake() || reference_search_.is_active();
  const bool may_still_move = !heartbeat_missing_ && (axis_.actual_velocity() != 0 || axis_.target_velocity() != 0);
  if (!was_started && !may_still_move) return;
  reference_search_.abort();
  axis_.stop();
}

Module::Recipient Module::recipient_on_bus(std::uint8_t address, hal::PortKind kind) const {
  if (kind == hal::PortKind::can) {
    return address == CanLine::to_group ? Recipient::group : Recipient::this_module_on_can;
  }
  if (address == address_setting(GlobalParameter::serial_address)) return Recipient::this_module;
  const std::uint8_t group = address_setting(GlobalParameter::serial_secondary_address);
  return group != 0 && address == group ? Recipient::group : Recipient::other;
}

inline void Module::write_reply(const Command& command, const Outcome& outcome, GlobalParameter own_address,
                                Datagram& reply) const {
  const std::uint8_t host = address_setting(GlobalParameter::serial_host_address);
  if (outcome.form == Outcome::Form::special) {
    reply.bytes[0] = host;
    for (std::size_t i = 0; i + 1 < datagram_size; ++i) reply.bytes[i + 1] = executor_.special_reply()[i];
    return;
  }
  // Of a CAN identifier the low byte.
  encode(Reply{host, address_setting(own_address), outcome.status, command.opcode, outcome.value}, reply);
}

Module::Handling Module::handle(const Datagram& request, hal::PortKind kind, Microseconds now, Datagram& reply) {
  return handle(request, kind, nullptr, now, reply);
}

inline Module::Handling Module::handle(const Datagram& request, hal::PortKind kind, Line* line, Microseconds now,
                                       Datagram& reply) {
  Recipient recipient = Recipient::this_module;
  if (kind != hal::PortKind::usb) {
    recipient = recipient_on_bus(request.bytes[0], kind);
    // The reply may have to wait: poll_lines() begins its pause in this turn.
    parts_due_ = others_due_ = now;
  }
  if (recipient == Recipient::other) return Handling::silent;
  if (!request.checksum_is_right()) {
    if (recipient == Recipient::group) return Handling::silent;
    write_reply(Command{}, {Status::wrong_checksum, 0, Outcome::Form::normal}, GlobalParameter::serial_address, reply);
    return Handling::answered;
  }
  const Command command = decode_request(request).command;
  if (line != nullptr) note_command(kind == hal::PortKind::can ? Interface::can : Interface::serial, now);
  Outcome outcome = executor_.execute_direct(command, now);
  if (outcome.form != Outcome::Form::result) {
    // All commands but those that read may have given the parts something to do.
    parts_due_ = others_due_ = now;
    if (outcome.form == Outcome::Form::busy) return Handling::busy;
    if (outcome.form == Outcome::Form::silent && outcome.status == Status::ok) return Handling::silent;
    if (outcome.form == Outcome::Form::mode_change) {
      if (line == nullptr || kind == hal::PortKind::rs485) {
        outcome.status = Status::command_not_available;
      } else {
        mode_change_ = line;
        lines_need_poll_ = true;
      }
    }
  }
  if (global_parameters_[GlobalParameter::suppress_reply] != 0) {
    const auto opcode = static_cast<Opcode>(command.opcode);
    if (opcode != Opcode::gap && opcode != Opcode::ggp && opcode != Opcode::gio) return Handling::silent;
  }
  if (recipient == Recipient::this_module) {
    write_reply(command, outcome, GlobalParameter::serial_address, reply);
    return Handling::answered;
  }
  if (recipient == Recipient::group) return Handling::silent;
  write_reply(command, outcome, GlobalParameter::can_id, reply);
  return Handling::answered;
}

Module::Snapshot Module::snapshot() {
  return {axis_.position(), axis_.actual_velocity(), axis_.settings()[AxisParameter::microstep_resolution],
          axis_.settings()[AxisParameter::pulse_divisor], program_machine_.mode()};
}

/// Second reply of command 138: status 128 and the mask of the motors (PD-1161 manual 3.7.52).
void Module::report_position() {
  constexpr std::int32_t first_motor = 1;
  if (report_line_->paused.has_reply() || !axis_.position_reached()) return;
  const Command command{static_cast<std::uint8_t>(Opcode::request_position_reached), 0, 0, 0};
  const GlobalParameter own_address =
      report_line_->kind == hal::PortKind::can ? GlobalParameter::can_id : GlobalParameter::serial_address;
  Datagram report;
  write_reply(command, {Status::position_reached, first_motor, Outcome::Form::normal}, own_address, report);
  report_line_->bytes->write(report.bytes, datagram_size);
  report_line_ = nullptr;
}

}  // namespace opentmcl
