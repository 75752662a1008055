#include <string>

#include "firmware/spec/instructions.hpp"
#include "lang/instruction_table.hpp"
#include "lang/program_check.hpp"

namespace opentmcl::lang {
namespace {

constexpr int wait_for_ticks = value_of_word(OperandKind::wait_event, "TICKS");
static_assert(wait_for_ticks >= 0);

/// Where an interrupt routine ends as it should: RETI; RST, which ends all; a STOP of its own, for emergencies.
AddressSet ends_of_routines(const CheckedProgram& program, const FlowFacts& facts) {
  AddressSet ends(facts.graph.size());
  for (Address address = 0; address < facts.graph.size(); ++address) {
    const Flow flow = facts.graph.flow(address);
    ends[address] = flow == Flow::return_from_interrupt || flow == Flow::restart ||
                    (flow == Flow::stop && !is_appended(program, address));
  }
  return ends;
}

void check_routines(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  const AddressSet ending = leading_to(facts.graph, ends_of_routines(program, facts), facts.main_alone);
  AddressSet reported(facts.graph.size());
  for (const InterruptEntry& entry : facts.interrupts) {
    if (reported[entry.routine] || is_appended(program, entry.routine)) continue;
    reported[entry.routine] = true;
    const Span routine = program.source_map[entry.routine];
    if (facts.main[entry.routine]) {
      diagnostics.add(DiagnosticKind::interrupt_entered_directly, routine,
                      "the program gets into this interrupt routine without an interrupt",
                      "made an interrupt routine here", program.source_map[entry.vect]);
    } else if (!ending[entry.routine]) {
      diagnostics.add(DiagnosticKind::interrupt_without_return, routine,
                      "this interrupt routine has no RETI: no further interrupt is taken once it has run",
                      "made an interrupt routine here", program.source_map[entry.vect]);
    }
  }
}

void check_waits(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  for (Address address = 0; address < facts.graph.size(); ++address) {
    const Command& command = facts.graph.command(address);
    const bool waits = command.opcode == static_cast<std::uint8_t>(Opcode::wait) && command.type != wait_for_ticks;
    if (!waits || command.value != 0 || !facts.interrupt[address]) continue;
    diagnostics.add(DiagnosticKind::endless_wait_in_interrupt, program.source_map[address],
                    "this WAIT has no time limit and stands in an interrupt routine: all else stands still",
                    "give the ticks of 10 ms to wait at most as last operand");
  }
}

}  // namespace

void check_interrupts(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  if (facts.interrupts.empty()) return;
  check_routines(program, facts, diagnostics);
  check_waits(program, facts, diagnostics);
}

}  // namespace opentmcl::lang
