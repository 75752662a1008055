#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "lang/flow_cycles.hpp"
#include "lang/program_check.hpp"

namespace opentmcl::lang {
namespace {

const std::string limit_text = std::to_string(maximum_open_calls);

/// How many calls can be open at each address, where execution begins with none.
class CallDepth {
 public:
  CallDepth(const FlowGraph& graph, const FlowCycles& cycles)
      : graph_(&graph), cycles_(&cycles), order_(cycles.in_order()), depths_(cycles.component_count()) {
    spread();
  }

  /// Begins at `address` with `depth` calls open.
  void begin_at(Address address, std::uint32_t depth) {
    std::uint32_t& known = depths_[cycles_->component(address)];
    known = std::max(known, depth);
  }

  /// Brings all addresses up to date. A recursive call counts as none: it is a warning of its own.
  void spread() {
    for (const Address address : order_) {
      const std::uint32_t depth = at(address);
      for_each_step(*graph_, address, {true, false}, [&](Address successor) {
        const bool is_call = graph_->flow(address) == Flow::call && successor == graph_->target(address) &&
                             cycles_->component(successor) != cycles_->component(address);
        begin_at(successor, depth + (is_call ? 1 : 0));
      });
    }
  }

  std::uint32_t at(Address address) const { return depths_[cycles_->component(address)]; }

  std::uint32_t deepest(const AddressSet& addresses) const {
    std::uint32_t depth = 0;
    for (Address address = 0; address < graph_->size(); ++address) {
      if (addresses[address]) depth = std::max(depth, at(address));
    }
    return depth;
  }

 private:
  const FlowGraph* graph_;
  const FlowCycles* cycles_;
  std::vector<Address> order_;
  std::vector<std::uint32_t> depths_;  // by component
};

void check_recursion(const CheckedProgram& program, const FlowGraph& graph, const FlowCycles& cycles,
                     DiagnosticList& diagnostics) {
  for (Address address = 0; address < graph.size(); ++address) {
    if (graph.flow(address) != Flow::call || !graph.has_target(address)) continue;
    if (cycles.component(address) != cycles.component(graph.target(address))) continue;
    diagnostics.add(DiagnosticKind::recursive_subroutine, program.source_map[address],
                    "this subroutine can get back to this call without returning first",
                    "a subroutine ends with RSUB; with " + limit_text + " calls open further ones are ignored");
  }
}

/// Reports calls with a full stack. Returns whether there are any.
bool report_too_deep(const CheckedProgram& program, const FlowGraph& graph, const CallDepth& depth,
                     const std::string& note, DiagnosticList& diagnostics) {
  bool found = false;
  for (Address address = 0; address < graph.size(); ++address) {
    if (graph.flow(address) != Flow::call || depth.at(address) < maximum_open_calls) continue;
    found = true;
    diagnostics.add(DiagnosticKind::subroutines_nested_too_deep, program.source_map[address],
                    "this call is ignored if " + std::to_string(depth.at(address)) +
                        " calls are open already, as the program allows; the module keeps " + limit_text,
                    note);
  }
  return found;
}

void check_depth(const CheckedProgram& program, const FlowFacts& facts, const FlowCycles& cycles,
                 DiagnosticList& diagnostics) {
  CallDepth depth(facts.graph, cycles);
  if (report_too_deep(program, facts.graph, depth, {}, diagnostics) || facts.interrupts.empty()) return;
  // An interrupt can come when the main program has most calls open, and its routine uses the same stack.
  const std::uint32_t open_calls = depth.deepest(facts.main);
  for (const InterruptEntry& entry : facts.interrupts) {
    if (!facts.main[entry.routine]) depth.begin_at(entry.routine, open_calls);
  }
  depth.spread();
  report_too_deep(program, facts.graph, depth,
                  std::to_string(open_calls) + " of them are of the program that is interrupted", diagnostics);
}

void check_returns(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  for (Address address = 0; address < facts.graph.size(); ++address) {
    const Flow flow = facts.graph.flow(address);
    if (!facts.main_alone[address] || (flow != Flow::return_from_call && flow != Flow::return_from_interrupt)) continue;
    const bool is_subroutine = flow == Flow::return_from_call;
    diagnostics.add(DiagnosticKind::return_without_call, program.source_map[address],
                    is_subroutine ? "the program gets to this RSUB without a call, and it is ignored then"
                                  : "the program gets to this RETI without an interrupt",
                    "is a STOP or JA missing before the routine?");
  }
}

}  // namespace

void check_subroutines(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  check_returns(program, facts, diagnostics);
  const bool has_calls = std::any_of(program.commands.begin(), program.commands.end(),
                                     [](const Command& command) { return flow_of(command.opcode) == Flow::call; });
  if (!has_calls) return;
  const FlowCycles cycles(facts.graph, {true, false});
  check_recursion(program, facts.graph, cycles, diagnostics);
  check_depth(program, facts, cycles, diagnostics);
}

}  // namespace opentmcl::lang
