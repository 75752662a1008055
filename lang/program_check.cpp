#include "lang/program_check.hpp"

#include <algorithm>

#include "firmware/spec/instructions.hpp"

namespace opentmcl::lang {
namespace {

std::vector<InterruptEntry> find_interrupts(const FlowGraph& graph) {
  std::vector<InterruptEntry> entries;
  for (Address address = 0; address < graph.size(); ++address) {
    if (graph.command(address).opcode != static_cast<std::uint8_t>(Opcode::vect)) continue;
    if (graph.has_target(address)) entries.push_back({address, graph.target(address)});
  }
  return entries;
}

bool has_calls(const CheckedProgram& program) {
  return std::any_of(program.commands.begin(), program.commands.end(),
                     [](const Command& command) { return flow_of(command.opcode) == Flow::call; });
}

/// A JA behind a JA is a row of a table whose rows the host starts by their addresses.
std::vector<Address> find_starts(const FlowGraph& graph) {
  std::vector<Address> starts;
  for (Address address = 0; address < graph.size(); ++address) {
    const bool is_row = address > 0 && graph.flow(address) == Flow::jump && graph.flow(address - 1) == Flow::jump;
    if (address == 0 || is_row) starts.push_back(address);
  }
  return starts;
}

}  // namespace

FlowFacts::FlowFacts(const CheckedProgram& program)
    : graph(program.commands),
      interrupts(find_interrupts(graph)),
      starts(find_starts(graph)),
      main_alone(reachable(graph, starts, {false, true})),
      main(has_calls(program) ? reachable(graph, starts, {true, true}) : main_alone),
      interrupt(graph.size()) {
  std::vector<Address> routines;
  for (const InterruptEntry& entry : interrupts) {
    if (!main_alone[entry.routine]) routines.push_back(entry.routine);
  }
  reach(graph, routines, {true, false}, main_alone, interrupt);
}

void check_program(const CheckedProgram& program, DiagnosticList& diagnostics) {
  const FlowFacts facts(program);
  check_reachability(program, facts, diagnostics);
  check_subroutines(program, facts, diagnostics);
  check_interrupts(program, facts, diagnostics);
  check_stores(program, facts, diagnostics);
  check_names(program, facts, diagnostics);
}

}  // namespace opentmcl::lang
