#include "lang/flow_graph.hpp"

#include <limits>

namespace opentmcl::lang {
namespace {

/// For each address the jumps to it: a list that goes from one jump to the next.
class Jumps {
 public:
  explicit Jumps(const FlowGraph& graph) : first_(graph.size(), none), next_(graph.size(), none) {
    for (Address address = 0; address < graph.size(); ++address) {
      const Flow flow = graph.flow(address);
      if ((flow != Flow::jump && flow != Flow::branch) || !graph.has_target(address)) continue;
      next_[address] = first_[graph.target(address)];
      first_[graph.target(address)] = address;
    }
  }

  template <typename Visit>
  void for_each_to(Address target, const Visit& visit) const {
    for (Address address = first_[target]; address != none; address = next_[address]) visit(address);
  }

 private:
  static constexpr Address none = std::numeric_limits<Address>::max();

  std::vector<Address> first_;
  std::vector<Address> next_;
};

}  // namespace

void reach(const FlowGraph& graph, const std::vector<Address>& entries, Steps steps, const AddressSet& closed,
           AddressSet& reached) {
  std::vector<Address> open;
  const auto enter = [&](Address address) {
    if (reached[address]) return;
    reached[address] = true;
    open.push_back(address);
  };
  for (const Address entry : entries) enter(entry);
  while (!open.empty()) {
    Address address = open.back();
    open.pop_back();
    // Instructions that follow each other are the common case and need no place on the stack.
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for_each_step(graph, address, steps, [&](Address successor) {
        const bool is_call = graph.flow(address) == Flow::call && successor == graph.target(address);
        if (reached[successor] || (!is_call && closed[successor])) return;
        if (successor == address + 1 && !is_call) {
          reached[successor] = true;
          goes_on = true;
        } else {
          enter(successor);
        }
      });
      ++address;
    }
  }
}

AddressSet reachable(const FlowGraph& graph, const std::vector<Address>& entries, Steps steps) {
  AddressSet reached(graph.size());
  reach(graph, entries, steps, AddressSet(graph.size()), reached);
  return reached;
}

AddressSet leading_to(const FlowGraph& graph, const AddressSet& goals, const AddressSet& closed) {
  const Jumps jumps(graph);
  AddressSet leading(graph.size());
  std::vector<Address> open;
  const auto enter = [&](Address address) {
    if (leading[address] || closed[address]) return;
    leading[address] = true;
    open.push_back(address);
  };
  for (Address address = 0; address < graph.size(); ++address) {
    if (goals[address]) enter(address);
  }
  while (!open.empty()) {
    const Address address = open.back();
    open.pop_back();
    if (address > 0 && graph.goes_on(address - 1)) enter(address - 1);
    jumps.for_each_to(address, enter);
  }
  return leading;
}

}  // namespace opentmcl::lang
