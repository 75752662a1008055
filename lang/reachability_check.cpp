#include <cstddef>
#include <string>

#include "lang/program_check.hpp"

namespace opentmcl::lang {
namespace {

/// Operands beyond this are warned of as such: lang/command_check.hpp.
constexpr std::int32_t largest_address = 65535;

void check_targets(const CheckedProgram& program, const FlowGraph& graph, DiagnosticList& diagnostics) {
  // What is to go behind the last instruction is warned of where the label stands.
  bool has_label_at_end = false;
  for (const Symbol& symbol : program.symbols.symbols()) {
    has_label_at_end = has_label_at_end || (symbol.kind == SymbolKind::label && symbol.value == graph.size());
  }
  for (Address address = 0; address < graph.size(); ++address) {
    const Flow flow = graph.flow(address);
    const bool has_address = (flow != Flow::next && flow != Flow::stop && flow != Flow::return_from_call &&
                              flow != Flow::return_from_interrupt) ||
                             graph.command(address).opcode == static_cast<std::uint8_t>(Opcode::vect);
    if (!has_address || graph.has_target(address)) continue;
    const std::int32_t target = graph.command(address).value;
    if (target < 0 || target > largest_address) continue;
    if (has_label_at_end && static_cast<Address>(target) == graph.size()) continue;
    diagnostics.add(DiagnosticKind::jump_outside_program, program.source_map[address],
                    "address " + std::to_string(target) + " is behind the program, whose last one is " +
                        std::to_string(graph.size() - 1));
  }
}

void check_end(const CheckedProgram& program, const FlowFacts& facts, const AddressSet& reached,
               DiagnosticList& diagnostics) {
  if (facts.graph.size() == 0) return;
  const Address last = facts.graph.size() - 1;
  if (!reached[last] || !facts.graph.goes_on(last)) return;
  diagnostics.add(DiagnosticKind::no_stop_at_end, program.source_map[last],
                  "the program runs on behind its last instruction",
                  "end it with STOP or JA: what follows in the module's memory may be left of another program");
}

}  // namespace

void check_reachability(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  const FlowGraph& graph = facts.graph;
  std::vector<Address> entries = facts.starts;
  for (const InterruptEntry& entry : facts.interrupts) entries.push_back(entry.routine);
  for (const Symbol& symbol : program.symbols.symbols()) {
    const bool is_entry = symbol.kind == SymbolKind::label && symbol.value < graph.size();
    if (is_entry) entries.push_back(static_cast<Address>(symbol.value));
  }
  if (graph.size() == 0) return;
  const AddressSet reached = reachable(graph, entries, {true, true});
  check_targets(program, graph, diagnostics);
  check_end(program, facts, reached, diagnostics);

  for (Address address = 0; address < graph.size(); ++address) {
    // A STOP that nothing reaches marks the end of a part of the program and does no harm.
    if (reached[address] || graph.flow(address) == Flow::stop) continue;
    const Address first = address;
    while (address + 1 < graph.size() && !reached[address + 1] && graph.flow(address + 1) != Flow::stop) ++address;
    const std::size_t count = address - first + 1;
    diagnostics.add(DiagnosticKind::unreachable_code, program.source_map[first],
                    count == 1 ? "nothing reaches this instruction"
                               : "nothing reaches this and the next " + std::to_string(count - 1) +
                                     (count == 2 ? " instruction" : " instructions"),
                    "give it a label if the host is to start the program here");
  }
}

}  // namespace opentmcl::lang
