#include "lang/flow_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "lang/assembling_test.hpp"
#include "lang/flow_cycles.hpp"

namespace opentmcl::lang {
namespace {

using testing::ElementsAre;

std::vector<Command> any_program() {
  const auto size = *rc::gen::inRange<std::size_t>(1, 25);
  std::vector<Command> program(size);
  for (Command& one : program) {
    const Opcode opcode = *rc::gen::element(Opcode::mst, Opcode::ja, Opcode::jc, Opcode::djnz, Opcode::csub,
                                            Opcode::call, Opcode::rsub, Opcode::reti, Opcode::rst, Opcode::stop);
    one = command(opcode, 0, 0, *rc::gen::inRange(-1, static_cast<int>(size) + 1));
  }
  return program;
}

Steps any_steps() {
  return {*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>()};
}

/// Whether steps lead from one address to another, by trying them all: at least one step.
std::vector<std::vector<bool>> closure(const FlowGraph& graph, Steps steps) {
  const Address size = graph.size();
  std::vector<std::vector<bool>> leads(size, std::vector<bool>(size));
  for (Address from = 0; from < size; ++from) {
    for_each_step(graph, from, steps, [&](Address to) { leads[from][to] = true; });
  }
  for (Address middle = 0; middle < size; ++middle) {
    for (Address from = 0; from < size; ++from) {
      for (Address to = 0; to < size; ++to) {
        if (leads[from][middle] && leads[middle][to]) leads[from][to] = true;
      }
    }
  }
  return leads;
}

TEST(FlowGraph, GoesWhereTheModuleGoes) {
  const std::vector<Command> program = commands_of(
      "A: MST 0\n JA C\n JC ZE, A\n DJNZ 1, A\n CSUB A\n CALL ZE, A\n RSUB\n RETI\n RST A\n STOP\n"
      "C: VECT 0, A\n JA A");
  const FlowGraph graph(program);
  const auto steps_of = [&](Address address, Steps steps) {
    std::vector<Address> found;
    for_each_step(graph, address, steps, [&](Address successor) { found.push_back(successor); });
    return found;
  };
  EXPECT_THAT(steps_of(0, {}), ElementsAre(1U));
  EXPECT_THAT(steps_of(1, {}), ElementsAre(10U));
  EXPECT_THAT(steps_of(2, {}), ElementsAre(3U, 0U));
  EXPECT_THAT(steps_of(3, {}), ElementsAre(4U, 0U));
  EXPECT_THAT(steps_of(4, {}), ElementsAre(5U));
  EXPECT_THAT(steps_of(4, {true, false}), ElementsAre(5U, 0U));
  EXPECT_THAT(steps_of(5, {true, false}), ElementsAre(6U, 0U));
  for (const Address end : {6U, 7U, 8U, 9U}) EXPECT_THAT(steps_of(end, {true, false}), ElementsAre()) << end;
  EXPECT_THAT(steps_of(8, {false, true}), ElementsAre(0U));
  EXPECT_THAT(steps_of(10, {}), ElementsAre(11U));
}

RC_GTEST_PROP(FlowGraph, ReachesWhatStepsLeadTo, ()) {
  const std::vector<Command> program = any_program();
  const FlowGraph graph(program);
  const Steps steps = any_steps();
  const auto leads = closure(graph, steps);
  const AddressSet reached = reachable(graph, {0}, steps);
  for (Address address = 0; address < graph.size(); ++address) {
    RC_ASSERT(reached[address] == (address == 0 || leads[0][address]));
  }
}

RC_GTEST_PROP(FlowGraph, LeadsBackToWhatReachesIt, ()) {
  const std::vector<Command> program = any_program();
  const FlowGraph graph(program);
  const auto leads = closure(graph, {});
  const auto goal = *rc::gen::inRange<Address>(0, graph.size());
  AddressSet goals(graph.size());
  goals[goal] = true;
  const AddressSet leading = leading_to(graph, goals, AddressSet(graph.size()));
  for (Address address = 0; address < graph.size(); ++address) {
    RC_ASSERT(leading[address] == (address == goal || leads[address][goal]));
  }
}

RC_GTEST_PROP(FlowCycles, AreWhereEachAddressReachesTheOther, ()) {
  const std::vector<Command> program = any_program();
  const FlowGraph graph(program);
  const Steps steps = any_steps();
  const auto leads = closure(graph, steps);
  const FlowCycles cycles(graph, steps);
  for (Address from = 0; from < graph.size(); ++from) {
    RC_ASSERT(cycles.is_on_cycle(from) == leads[from][from]);
    for (Address to = 0; to < graph.size(); ++to) {
      const bool together = from == to || (leads[from][to] && leads[to][from]);
      RC_ASSERT((cycles.component(from) == cycles.component(to)) == together);
      if (leads[from][to]) RC_ASSERT(cycles.component(to) <= cycles.component(from));
    }
  }
  const std::vector<Address> order = cycles.in_order();
  RC_ASSERT(order.size() == graph.size());
  RC_ASSERT(std::is_sorted(order.begin(), order.end(), [&](Address left, Address right) {
    return cycles.component(left) > cycles.component(right);
  }));
}

TEST(FlowCycles, AreFoundInAMillionInstructionsWithoutRecursion) {
  std::vector<Command> program(1000000, command(Opcode::csub, 0, 0, 999999));
  program.back() = command(Opcode::ja, 0, 0, 0);
  const FlowGraph graph(program);
  EXPECT_EQ(FlowCycles(graph, {true, true}).component_count(), 1U);
  EXPECT_EQ(FlowCycles(graph, {false, false}).component_count(), 1U);
}

}  // namespace
}  // namespace opentmcl::lang
