#include "debug/engine.hpp"

#include <algorithm>
#include <utility>

#include "debug/mistake.hpp"
#include "lang/assembler.hpp"
#include "lang/diagnostic.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"

namespace opentmcl::debug {

using client::Error;
using client::ErrorKind;
using client::ProgramStatus;
using client::Result;

Engine::Engine(Target& target, Program program, Output output)
    : target_(target),
      program_(std::move(program)),
      output_(std::move(output)),
      stops_at_(target.module().program_capacity),
      calls_(program_.commands()) {}

// ---- The program in the module

Result<MemoryComparison> Engine::compare(const client::Progress& progress) {
  client::Client& client = target_.client();
  constexpr auto code_protection = static_cast<std::uint8_t>(GlobalParameter::code_protection);
  const Result<std::int32_t> protection = client.global_parameter(code_protection, Bank::module_settings);
  if (!protection) return protection.error();
  MemoryComparison comparison;
  comparison.readable = (*protection & 1) == 0;
  comparison.writable = (*protection & 2) == 0;
  if (!comparison.readable) return comparison;
  for (std::size_t i = 0; i < program_.size(); ++i) {
    const auto address = static_cast<std::uint16_t>(i);
    const Result<Command> found = client::read_instruction(client, address);
    if (!found) return found.error();
    if (*found != program_.commands()[i]) comparison.differing.push_back(address);
    if (!progress(i + 1, program_.size())) return Error{ErrorKind::interrupted, "interrupted", {}};
  }
  if (program_.size() < target_.module().program_capacity) {
    const Result<Command> behind = client::read_instruction(client, static_cast<std::uint16_t>(program_.size()));
    if (!behind) return behind.error();
    comparison.end_is_marked = *behind == client::end_mark;
  }
  return comparison;
}

Result<std::size_t> Engine::download(const MemoryComparison& comparison, const client::Progress& progress) {
  if (!comparison.writable) {
    return Error{ErrorKind::refused,
                 "the module's program is protected against overwriting (global parameter 81): it cannot be exchanged "
                 "before `tmcl set --global 0 81 0`, which erases a program that is protected against reading, too",
                 {}};
  }
  const std::vector<Command> image = client::with_end_mark(program_.commands(), target_.module().program_capacity);
  struct Range {
    std::size_t begin;
    std::size_t end;
  };
  // A range costs two commands and a page or two of the EEPROM: a few instructions more cost less.
  constexpr std::size_t worth_a_range = 8;
  std::vector<Range> ranges;
  const auto send = [&ranges](std::size_t address) {
    if (!ranges.empty() && address < ranges.back().end + worth_a_range) {
      ranges.back().end = address + 1;
    } else {
      ranges.push_back({address, address + 1});
    }
  };
  if (!comparison.readable) {
    ranges.push_back({0, image.size()});
  } else {
    for (const std::uint16_t address : comparison.differing) send(address);
    if (!comparison.end_is_marked) send(program_.size());
  }
  std::size_t total = 0;
  for (const Range& range : ranges) total += range.end - range.begin;
  std::size_t sent = 0;
  for (const Range& range : ranges) {
    const auto begin = image.begin();
    const std::vector<Command> part(begin + static_cast<std::ptrdiff_t>(range.begin),
                                    begin + static_cast<std::ptrdiff_t>(range.end));
    Result<void> loaded = client::download(target_.client(), part, static_cast<std::uint16_t>(range.begin),
                                           [&](std::size_t done, std::size_t) { return progress(sent + done, total); });
    if (!loaded) return loaded.error();
    sent += part.size();
  }
  beyond_.clear();
  const bool sent_mark = !ranges.empty() && ranges.back().end > program_.size();
  return sent - (sent_mark ? 1 : 0);
}

Result<Stop> Engine::restart() {
  const Result<ProgramStatus> status = target_.restart();
  if (!status) return status.error();
  status_ = *status;
  calls_.reset();
  recent_.clear();
  running_ = ended_ = false;
  at_instruction_ = true;
  for (auto& [number, breakpoint] : breakpoints_) breakpoint.hits = 0;
  return stand(Stop::Reason::entry);
}

Result<Stop> Engine::attach() {
  const Result<ProgramStatus> status = target_.status();
  if (!status) return status.error();
  status_ = *status;
  calls_.forget();
  running_ = status->state == ProgramStatus::State::running;
  ended_ = false;
  at_instruction_ = true;
  const bool still_runs = running_;
  Stop found = stand(Stop::Reason::entry);
  running_ = still_runs;
  return found;
}

Result<Stop> Engine::jump(std::uint16_t address) {
  const Result<ProgramStatus> status = target_.jump(address);
  if (!status) return status.error();
  status_ = *status;
  calls_.reset();
  ended_ = false;
  at_instruction_ = true;
  return stand(Stop::Reason::entry);
}

Result<void> Engine::detach() {
  if (ended_) return {};
  return target_.let_run();
}

Result<void> Engine::stop_all() {
  if (Result<void> stopped = target_.client().stop_program(); !stopped) return stopped;
  return target_.client().stop();
}

Result<Stop> Engine::go(const Motion& motion, const KeepGoing& keep_going) {
  switch (motion.kind) {
    case Motion::Kind::reverse_step:
    case Motion::Kind::reverse_step_over:
    case Motion::Kind::reverse_step_out:
    case Motion::Kind::reverse_run:
      return go_back(motion, keep_going);
    default:
      return go_forward(motion, keep_going);
  }
}

// ---- Values

Result<std::int32_t> Engine::accumulator() {
  return target_.client().accumulator();
}

Result<std::int32_t> Engine::x_register() {
  return target_.client().x_register();
}

Result<std::int32_t> Engine::program_counter() {
  return std::int32_t{status_.program_counter};
}

Result<std::int32_t> Engine::read(const Command& command) {
  return target_.client().execute(command);
}

Result<RegisterValues> Engine::registers() {
  const Result<std::int32_t> a = accumulator();
  if (!a) return a.error();
  const Result<std::int32_t> x = x_register();
  if (!x) return x.error();
  RegisterValues values;
  values.accumulator = *a;
  values.x = *x;
  values.program_counter = status_.program_counter;
  if (const TwinPowers* const twin = target_.twin()) values.inner = twin->inner_state();
  return values;
}

Result<void> Engine::set_accumulator(std::int32_t value) {
  const Result<std::int32_t> loaded = execute("CALC LOAD, " + std::to_string(value));
  if (!loaded) return loaded.error();
  return {};
}

/// CALCX LOAD copies the accumulator, which therefore is lent for it.
Result<void> Engine::set_x(std::int32_t value) {
  const Result<std::int32_t> kept = accumulator();
  if (!kept) return kept.error();
  if (Result<void> lent = set_accumulator(value); !lent) return lent;
  const Result<std::int32_t> copied = execute("CALCX LOAD");
  Result<void> restored = set_accumulator(*kept);
  if (!copied) return copied.error();
  return restored;
}

Result<std::int32_t> Engine::variable(std::uint8_t number) {
  return target_.client().global_parameter(number, Bank::user_variables);
}

Result<void> Engine::set_variable(std::uint8_t number, std::int32_t value) {
  return target_.client().set_global_parameter(number, Bank::user_variables, value);
}

std::vector<Frame> Engine::frames() {
  std::vector<OpenRoutine> open;  // the outermost first
  if (const TwinPowers* const twin = target_.twin()) {
    const InnerState inner = twin->inner_state();
    for (std::size_t i = 0; i <= inner.depth; ++i) {
      if (inner.interrupted && i == std::min(inner.interrupted_depth, inner.depth)) {
        open.push_back({*inner.interrupted, true});
      }
      if (i < inner.depth) open.push_back({inner.return_addresses[i], false});
    }
  } else {
    open = calls_.routines();
  }
  std::vector<Frame> frames;
  std::uint16_t address = status_.program_counter;
  std::reverse(open.begin(), open.end());
  for (const OpenRoutine& routine : open) {
    frames.push_back({address, routine.is_interrupt});
    address = routine.return_address;
  }
  frames.push_back({address, false});
  return frames;
}

bool Engine::frames_are_whole() const {
  return target_.twin() != nullptr || calls_.is_whole();
}

bool Engine::is_instruction(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  std::size_t end = begin;
  while (end < text.size() && lang::continues_name(text[end])) ++end;
  if (lang::find_mnemonic(text.substr(begin, end - begin)) == nullptr) return false;
  const std::size_t next = text.find_first_not_of(" \t", end);
  return next == std::string_view::npos || text[next] != '(';
}

Result<Command> Engine::parsed(std::string_view instruction) const {
  const lang::InstructionResult result = lang::parse_instruction(instruction, program_.module());
  if (result.command) return *result.command;
  for (const lang::Diagnostic& diagnostic : result.diagnostics) {
    if (diagnostic.severity() != lang::Severity::error) continue;
    const std::string note = diagnostic.note.empty() ? "" : " (" + diagnostic.note + ")";
    return mistake(lang::in_quotes(instruction) + ": " + diagnostic.message + note);
  }
  return mistake(lang::in_quotes(instruction) + " is no instruction");
}

Result<double> Engine::evaluate(std::string_view text) {
  if (!is_instruction(text)) {
    const Result<ValueExpression> expression = ValueExpression::parse(text, program_);
    if (!expression) return expression.error();
    return expression->evaluate(*this);
  }
  const Result<Command> command = parsed(text);
  if (!command) return command.error();
  const InstructionSpec* const row = find_instruction(command->opcode, program_.module().id);
  if (!row->reads) {
    return mistake(std::string(row->mnemonic) +
                   " has no value to show; expected an expression such as A or VAR(3), or an instruction that reads, "
                   "such as GAP 1, 0");
  }
  const Result<std::int32_t> value = read(*command);
  if (!value) return value.error();
  return static_cast<double>(*value);
}

Result<std::int32_t> Engine::execute(std::string_view instruction) {
  const Result<Command> command = parsed(instruction);
  if (!command) return command.error();
  return target_.client().execute(*command);
}

Result<Command> Engine::command_at(std::uint16_t address) {
  if (address < program_.size()) return program_.commands()[address];
  if (const auto known = beyond_.find(address); known != beyond_.end()) return known->second;
  Result<Command> read = client::read_instruction(target_.client(), address);
  if (read) beyond_.emplace(address, *read);
  return read;
}

}  // namespace opentmcl::debug
