#include "lang/flow_cycles.hpp"

#include <algorithm>
#include <limits>

namespace opentmcl::lang {
namespace {

constexpr std::uint32_t no_component = std::numeric_limits<std::uint32_t>::max();

/// An address whose steps are being followed.
struct Visit {
  Address address;
  unsigned next_step;
};

}  // namespace

FlowCycles::FlowCycles(const FlowGraph& graph, Steps steps)
    : graph_(&graph),
      steps_(steps),
      components_(graph.size(), no_component),
      found_(graph.size()),
      lowest_(graph.size()) {
  order_.reserve(graph.size());
  for (Address address = 0; address < graph.size(); ++address) {
    if (found_[address] == 0) visit(address);
  }
}

void FlowCycles::visit(Address root) {
  std::vector<Visit> open;
  const auto enter = [&](Address address) {
    found_[address] = lowest_[address] = ++time_;
    path_.push_back(address);
    open.push_back({address, 0});
  };
  enter(root);
  while (!open.empty()) {
    const Address address = open.back().address;
    Address steps[2] = {};
    unsigned count = 0;
    for_each_step(*graph_, address, steps_, [&](Address successor) { steps[count++] = successor; });
    if (open.back().next_step < count) {
      const Address successor = steps[open.back().next_step++];
      if (found_[successor] == 0) {
        enter(successor);
      } else if (components_[successor] == no_component) {
        lowest_[address] = std::min(lowest_[address], found_[successor]);
      }
      continue;
    }
    open.pop_back();
    if (lowest_[address] == found_[address]) close(address);
    if (!open.empty()) lowest_[open.back().address] = std::min(lowest_[open.back().address], lowest_[address]);
  }
}

void FlowCycles::close(Address address) {
  const std::size_t first = order_.size();
  Address member = 0;
  do {
    member = path_.back();
    path_.pop_back();
    components_[member] = component_count_;
    order_.push_back(member);
  } while (member != address);
  bool is_cycle = order_.size() - first > 1;
  for_each_step(*graph_, address, steps_, [&](Address successor) { is_cycle = is_cycle || successor == address; });
  is_cycle_.push_back(is_cycle);
  ++component_count_;
}

std::vector<Address> FlowCycles::in_order() const {
  return {order_.rbegin(), order_.rend()};
}

}  // namespace opentmcl::lang
