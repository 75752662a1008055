#include "debug/twin/twin_target.hpp"

#include <algorithm>
#include <utility>

#include "debug/mistake.hpp"
#include "firmware/module/module.hpp"
#include "firmware/spec/io_ports.hpp"
#include "lang/diagnostic.hpp"
#include "scenario/condition.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::ProgramStatus;
using client::Result;

namespace {

constexpr Command control(Opcode opcode, std::int32_t value = 0, std::uint8_t type = 0) {
  return {static_cast<std::uint8_t>(opcode), type, 0, value};
}

Datagram request_of(const Command& command) {
  constexpr std::uint8_t any_address = 1;
  return encode(Request{any_address, command});
}

/// Whether a command only looks. What is done again when the twin goes back in time need not include it.
bool only_reads(const Command& command) {
  switch (static_cast<Opcode>(command.opcode)) {
    case Opcode::gap:
      return command.type != static_cast<std::uint8_t>(AxisParameter::extended_error_flags);
    case Opcode::ggp:
    case Opcode::gio:
    case Opcode::read_program_memory:
    case Opcode::get_application_status:
    case Opcode::get_firmware_version:
      return true;
    default:
      return false;
  }
}

/// While a program waits, its firmware looks every millisecond without taking a turn; after so many of these looks
/// others are asked whether to go on.
constexpr int most_vain_looks = 100;

/// Within it the firmware has written to its EEPROM whatever it wants to.
constexpr Microseconds time_to_settle = 500 * one_millisecond;
constexpr Microseconds longest_busy = 1000 * one_millisecond;

}  // namespace

class TwinTarget::TwinSignal final : public Signal {
 public:
  TwinSignal(TwinTarget& twin, scenario::Condition condition) : twin_(twin), condition_(std::move(condition)) {}

  bool holds() const override { return condition_.holds(twin_.module_->world()); }
  std::string values() const override { return condition_.values(twin_.module_->world()); }

 private:
  TwinTarget& twin_;
  scenario::Condition condition_;
};

TwinTarget::TwinTarget(TwinSetup setup, Listener listener)
    : setup_(std::move(setup)),
      listener_(std::move(listener)),
      transport_(*this, std::string("sim:") + setup_.scenario.module->argument),
      client_(transport_) {
  begin(false);
}

TwinTarget::~TwinTarget() = default;

/// A module that has just been switched on, with all that is done to it before its history begins.
void TwinTarget::begin(bool starts_program) {
  scenario_run_.reset();
  VirtualModule::Options board = setup_.scenario.board();
  board.turn = setup_.turn;
  board.tables = tables_;
  module_ = std::make_unique<VirtualModule>(module(), std::vector<hal::Port>(), board);
  setup_.scenario.write_initial(module_->world());
  if (setup_.eeprom) module_->world().eeprom().load(*setup_.eeprom);
  module_->advance_to(module_->now());
  was_in_interrupt_ = false;
  repeated_ = 0;
  if (!starts_program) return;
  bool busy = false;
  carry_out(request_of(control(Opcode::stop_application)), busy);
  carry_out(request_of(control(Opcode::reset_application)), busy);
  carry_out(request_of(control(Opcode::run_application)), busy);
  scenario_run_.emplace(setup_.scenario, *module_, [this](const scenario::Report& report) {
    if (listener_ && module_->now() > furthest_) listener_(report);
  });
  module_->add_actor(*scenario_run_);
}

bool TwinTarget::program_runs() const {
  return module_->module().program().is_running();
}

Result<ProgramStatus> TwinTarget::status() {
  const ProgramMachine& program = module_->module().program();
  return ProgramStatus{static_cast<ProgramStatus::State>(program.mode()), program.is_waiting(),
                       program.program_counter()};
}

Result<ProgramStatus> TwinTarget::restart() {
  bool busy = false;
  carry_out(request_of(control(Opcode::stop_application)), busy);
  // What the bench does in this time is no part of any history.
  furthest_ = never;
  module_->advance_to(module_->now() + time_to_settle);
  setup_.eeprom = module_->world().eeprom().image();
  deeds_.clear();
  furthest_ = 0;
  begin(true);
  beginning_ = now();
  return status();
}

Result<ProgramStatus> TwinTarget::step(std::uint16_t, const Command&) {
  while (repeated_ < deeds_.size() && deeds_[repeated_].moment.turns == module_->turns()) repeat(deeds_[repeated_]);
  if (program_runs()) take_turn();
  furthest_ = std::max(furthest_, module_->now());
  return status();
}

/// At most one, after which the program may have executed an instruction.
void TwinTarget::take_turn() {
  const ProgramMachine& program = module_->module().program();
  const std::uint64_t turns = module_->turns();
  // In the turn in which an interrupt routine is entered, its first instruction is executed, which may be a call.
  const std::size_t depth = program.depth();
  for (int look = 0; look < most_vain_looks && module_->turns() == turns; ++look) {
    const Microseconds next = module_->next_turn();
    if (next == never) return;
    module_->advance_to(std::max(next, module_->now()));
  }
  const bool is_in_interrupt = program.is_in_interrupt();
  if (is_in_interrupt && !was_in_interrupt_) interrupted_depth_ = depth;
  was_in_interrupt_ = is_in_interrupt;
}

Result<ProgramStatus> TwinTarget::jump(std::uint16_t address) {
  constexpr std::uint8_t from_address = 1;
  const Result<std::int32_t> jumped = client_.execute(control(Opcode::run_application, address, from_address));
  if (!jumped) return jumped.error();
  return status();
}

// ---- Commands from outside

std::optional<Datagram> TwinTarget::carry_out(const Datagram& request, bool& busy) {
  Datagram reply;
  const opentmcl::Module::Handling handling =
      module_->module().handle(request, hal::PortKind::usb, module_->now(), reply);
  busy = handling == opentmcl::Module::Handling::busy;
  // The firmware looks at what changed in its next turn; where none is near it is woken, as by bytes at a port.
  if (!only_reads(decode_request(request).command) && module_->next_turn() > module_->now() + setup_.turn) {
    module_->wake();
  }
  if (handling != opentmcl::Module::Handling::answered) return std::nullopt;
  return reply;
}

Result<std::optional<Datagram>> TwinTarget::answer(const Datagram& request) {
  const Command command = decode_request(request).command;
  const Microseconds give_up = module_->now() + longest_busy;
  while (true) {
    if (!only_reads(command)) note({now(), command});
    bool busy = false;
    std::optional<Datagram> reply = carry_out(request, busy);
    if (!busy) return reply;
    if (program_runs() || module_->now() >= give_up) {
      return Error{ErrorKind::refused,
                   "the module's EEPROM is busy, and time stands still: let the program go on for some milliseconds, "
                   "then try again",
                   {}};
    }
    module_->advance_to(module_->now() + one_millisecond);
  }
}

void TwinTarget::let_pass(Microseconds duration) {
  if (!program_runs()) module_->advance_to(module_->now() + duration);
}

// ---- History

void TwinTarget::note(const Deed& deed) {
  // In the past, another future begins here.
  deeds_.resize(repeated_, deed);
  furthest_ = std::min(furthest_, module_->now());
  deeds_.push_back(deed);
  ++repeated_;
}

/// Between two turns. Not even to the present is the module advanced in vain: it may have a turn to take there.
void TwinTarget::pass_time_until(Microseconds time) {
  if (module_->now() < time) module_->advance_to(time);
}

void TwinTarget::repeat(const Deed& deed) {
  pass_time_until(deed.moment.time);
  ++repeated_;
  if (const auto* const command = std::get_if<Command>(&deed.what)) {
    bool busy = false;
    carry_out(request_of(*command), busy);
  } else {
    const auto& set = std::get<QuantitySet>(deed.what);
    set.quantity->write(module_->world(), set.value);
  }
}

void TwinTarget::repeat_deeds_until(Moment moment) {
  while (repeated_ < deeds_.size() && deeds_[repeated_].moment.turns == module_->turns() &&
         !(moment < deeds_[repeated_].moment)) {
    repeat(deeds_[repeated_]);
  }
}

Result<void> TwinTarget::go_to(Moment moment, const std::function<bool()>& keep_going) {
  if (moment < now()) begin(true);
  constexpr unsigned turns_between_questions = 1 << 12;
  for (unsigned turns = 1;; ++turns) {
    repeat_deeds_until(moment);
    if (module_->turns() >= moment.turns) break;
    if (module_->next_turn() == never) {
      return Error{ErrorKind::internal, "the twin cannot repeat its history", {}};
    }
    take_turn();
    if (turns % turns_between_questions == 0 && !keep_going()) {
      return Error{ErrorKind::interrupted, "interrupted", {}};
    }
  }
  pass_time_until(moment.time);
  return {};
}

// ---- What can be seen

InnerState TwinTarget::inner_state() const {
  const ProgramMachine& program = module_->module().program();
  InnerState state;
  state.comparison = program.registers.comparison == Registers::lower   ? Comparison::lower
                     : program.registers.comparison == Registers::equal ? Comparison::equal
                                                                        : Comparison::greater;
  state.error_flags = program.registers.error_flags;
  state.depth = program.depth();
  for (std::uint8_t i = 0; i < program.depth(); ++i) state.return_addresses[i] = program.return_address(i);
  if (program.is_in_interrupt()) state.interrupted = program.interrupted_program_counter();
  state.interrupted_depth = interrupted_depth_;
  for (std::size_t row = 0; row < std::size(interrupts); ++row) {
    if (!program.interrupts.is_enabled(row)) continue;
    state.enabled_interrupts.push_back(static_cast<std::uint8_t>(interrupts[row].number));
  }
  return state;
}

std::size_t TwinTarget::depth() const {
  const ProgramMachine& program = module_->module().program();
  return program.depth() + (program.is_in_interrupt() ? 1U : 0U);
}

Result<std::unique_ptr<Signal>> TwinTarget::signal(std::string_view condition) {
  scenario::Parsed<scenario::Condition> parsed = scenario::parse_condition(condition);
  if (const auto* const error = std::get_if<scenario::TextError>(&parsed)) {
    return mistake(lang::in_quotes(condition) + ", column " + std::to_string(error->offset + 1) + ": " +
                   error->message);
  }
  auto& understood = std::get<scenario::Condition>(parsed);
  for (const auto& all : understood.alternatives) {
    for (const scenario::Comparison& one : all) {
      for (const twin::Quantity* quantity : {one.left, one.right}) {
        if (quantity == nullptr) continue;
        if (const auto why = twin::absence(*quantity, module_->world())) {
          return mistake(std::string(quantity->name) + " " + *why);
        }
      }
    }
  }
  return {std::make_unique<TwinSignal>(*this, std::move(understood))};
}

Result<std::string> TwinTarget::quantity(std::string_view name) const {
  const twin::Quantity* const found = twin::find_quantity(name);
  if (found == nullptr) return mistake(scenario::no_such_quantity(name));
  if (const auto why = twin::absence(*found, module_->world())) return mistake(std::string(name) + " " + *why);
  return scenario::value_text(*found, module_->world());
}

Result<void> TwinTarget::set_quantity(std::string_view name, double value) {
  const twin::Quantity* const found = twin::find_quantity(name);
  if (found == nullptr) return mistake(scenario::no_such_quantity(name));
  if (const auto why = twin::refusal(*found, module_->world(), value)) return mistake(std::string(name) + " " + *why);
  note({now(), QuantitySet{found, value}});
  found->write(module_->world(), value);
  return {};
}

std::vector<std::string_view> TwinTarget::quantity_names() const {
  std::vector<std::string_view> names;
  for (const twin::Quantity& quantity : twin::quantities()) {
    if (quantity.exists_in(module_->world())) names.push_back(quantity.name);
  }
  return names;
}

std::uint8_t TwinTarget::troubles() const {
  // The bits of parameter 207 are those of Trouble.
  static_assert(static_cast<int>(AxisEvent::stall) == static_cast<int>(Trouble::stall));
  static_assert(static_cast<int>(AxisEvent::deviation) == static_cast<int>(Trouble::deviation));
  constexpr auto in_parameter_207 =
      static_cast<std::uint8_t>(static_cast<int>(Trouble::stall) | static_cast<int>(Trouble::deviation));
  auto found = static_cast<std::uint8_t>(module_->module().axis_error_flags() & in_parameter_207);
  constexpr std::int32_t millivolts = 100;  // in 0.1 V
  if (module_->world().supply_voltage() < lowest_supply_voltage * millivolts) {
    found = static_cast<std::uint8_t>(found | static_cast<std::uint8_t>(Trouble::under_voltage));
  }
  return found;
}

}  // namespace opentmcl::debug
