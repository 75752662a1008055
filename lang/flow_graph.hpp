// Where a program can go from each of its instructions. A graph without storage of its own: the successors follow from
// the instruction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::lang {

/// How an instruction hands on control.
enum class Flow : std::uint8_t {
  next,              ///< to the instruction behind it
  jump,              ///< to its address
  branch,            ///< to its address or to the instruction behind it
  call,              ///< to its address, and behind it when that returns; CALL may also not call
  return_from_call,  ///< RSUB
  return_from_interrupt,
  restart,  ///< RST: to its address, and no subroutine or interrupt is open any more
  stop,
};

constexpr Flow flow_of_opcode(Opcode opcode) {
  switch (opcode) {
    case Opcode::ja:
      return Flow::jump;
    case Opcode::jc:
    case Opcode::djnz:
      return Flow::branch;
    case Opcode::csub:
    case Opcode::call:
      return Flow::call;
    case Opcode::rsub:
      return Flow::return_from_call;
    case Opcode::reti:
      return Flow::return_from_interrupt;
    case Opcode::rst:
      return Flow::restart;
    case Opcode::stop:
      return Flow::stop;
    default:
      return Flow::next;
  }
}

struct FlowTable {
  Flow flows[256];
};

consteval FlowTable make_flow_table() {
  FlowTable table{};
  for (int opcode = 0; opcode < 256; ++opcode) table.flows[opcode] = flow_of_opcode(static_cast<Opcode>(opcode));
  return table;
}

inline constexpr FlowTable flow_table = make_flow_table();

constexpr Flow flow_of(std::uint8_t opcode) {
  return flow_table.flows[opcode];
}

/// Addresses of a program, each of them in the set or not.
using AddressSet = std::vector<bool>;

/// A program address.
using Address = std::uint32_t;

class FlowGraph {
 public:
  /// `commands` must outlive the graph.
  explicit FlowGraph(const std::vector<Command>& commands) : commands_(&commands) {}

  Address size() const { return static_cast<Address>(commands_->size()); }
  const Command& command(Address address) const { return (*commands_)[address]; }
  Flow flow(Address address) const { return flow_of((*commands_)[address].opcode); }

  /// Whether the instruction behind this one can follow, with a call seen as one step.
  bool goes_on(Address address) const {
    const Flow flow = this->flow(address);
    return flow == Flow::next || flow == Flow::branch || flow == Flow::call;
  }
  /// Whether the operand is an address of an instruction of this program.
  bool has_target(Address address) const {
    const std::int32_t value = command(address).value;
    return value >= 0 && static_cast<Address>(value) < size();
  }
  Address target(Address address) const { return static_cast<Address>((*commands_)[address].value); }

 private:
  const std::vector<Command>* commands_;
};

/// Which steps a search takes besides those to the next instruction and along jumps.
struct Steps {
  bool into_calls = false;
  bool along_restarts = false;
};

/// Calls `visit` with each address a step leads to from `address`.
template <typename Visit>
void for_each_step(const FlowGraph& graph, Address address, Steps steps, const Visit& visit) {
  if (graph.goes_on(address) && address + 1 < graph.size()) visit(address + 1);
  const Flow flow = graph.flow(address);
  const bool takes_target = flow == Flow::jump || flow == Flow::branch || (flow == Flow::call && steps.into_calls) ||
                            (flow == Flow::restart && steps.along_restarts);
  if (takes_target && graph.has_target(address)) visit(graph.target(address));
}

/// Adds to `reached` all addresses that steps from `entries` lead to, the entries themselves among them. Addresses in
/// `closed` are entered only by calls.
void reach(const FlowGraph& graph, const std::vector<Address>& entries, Steps steps, const AddressSet& closed,
           AddressSet& reached);
AddressSet reachable(const FlowGraph& graph, const std::vector<Address>& entries, Steps steps);

/// All addresses from which steps within a routine, not into calls, lead to one of `goals` without entering `closed`.
AddressSet leading_to(const FlowGraph& graph, const AddressSet& goals, const AddressSet& closed);

}  // namespace opentmcl::lang
