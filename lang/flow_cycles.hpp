#pragma once

#include <cstdint>
#include <vector>

#include "lang/flow_graph.hpp"

namespace opentmcl::lang {

/// The parts of a program that go round in circles: its strongly connected components, by Tarjan's algorithm, with a
/// stack of its own, so that no program is too long for it.
class FlowCycles {
 public:
  FlowCycles(const FlowGraph& graph, Steps steps);

  /// Addresses have the same component if each can be reached from the other. Every step leads to the same or to a
  /// smaller component.
  std::uint32_t component(Address address) const { return components_[address]; }
  std::uint32_t component_count() const { return component_count_; }
  /// Whether execution can come back to this address.
  bool is_on_cycle(Address address) const { return is_cycle_[components_[address]]; }
  /// All addresses, those of larger components first: each before what its steps lead to, but for cycles.
  std::vector<Address> in_order() const;

 private:
  void visit(Address root);
  void close(Address address);

  const FlowGraph* graph_;
  Steps steps_;
  std::uint32_t component_count_ = 0;
  std::vector<std::uint32_t> components_;
  std::vector<bool> is_cycle_;

  // while components are looked for
  std::uint32_t time_ = 0;
  std::vector<std::uint32_t> found_;   // when an address was visited first; 0: not yet
  std::vector<std::uint32_t> lowest_;  // the earliest address it leads back to
  std::vector<Address> path_;          // visited, in no component yet
  std::vector<Address> order_;         // by component, smallest first
};

}  // namespace opentmcl::lang
