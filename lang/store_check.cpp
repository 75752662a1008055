#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/lookup.hpp"
#include "lang/command_check.hpp"
#include "lang/flow_cycles.hpp"
#include "lang/program_check.hpp"

namespace opentmcl::lang {
namespace {

bool is_stored_when_written(const ParameterColumn& column) {
  return allows(column.access, Access::a);
}

/// What an instruction writes to the EEPROM each time it is executed, or nothing.
const char* written_to_eeprom(const Command& command, const ModuleDescription& module) {
  switch (static_cast<Opcode>(command.opcode)) {
    case Opcode::stap:
    case Opcode::stgp:
      return "it stores a parameter";
    case Opcode::sgp:
    case Opcode::agp: {
      if (command.motor != static_cast<std::uint8_t>(Bank::module_settings)) return nullptr;
      const std::uint8_t row = global_parameter_rows[command.type];
      return is_stored_when_written(row == no_row ? absent : global_parameters[row].in(module.id))
                 ? "this parameter is stored whenever it is written"
                 : nullptr;
    }
    case Opcode::sap:
    case Opcode::aap: {
      const std::uint8_t row = axis_parameter_rows[command.type];
      return is_stored_when_written(row == no_row ? absent : axis_parameters[row].in(module.id))
                 ? "this parameter is stored whenever it is written"
                 : nullptr;
    }
    case Opcode::sco:
      return command.motor == all_motors ? "it stores coordinates" : nullptr;
    default:
      return nullptr;
  }
}

bool is_timer(std::uint8_t interrupt) {
  const std::uint8_t row = interrupt_rows[interrupt];
  return row != no_row && interrupts[row].setting == InterruptSetting::period;
}

/// What is executed again and again without being on a cycle itself: subroutines that are called on one, and routines
/// of timers.
AddressSet repeated(const FlowFacts& facts, const FlowCycles& cycles) {
  std::vector<Address> entries;
  for (Address address = 0; address < facts.graph.size(); ++address) {
    if (facts.graph.flow(address) != Flow::call || !facts.graph.has_target(address)) continue;
    if (cycles.is_on_cycle(address)) entries.push_back(facts.graph.target(address));
  }
  for (const InterruptEntry& entry : facts.interrupts) {
    if (is_timer(facts.graph.command(entry.vect).type)) entries.push_back(entry.routine);
  }
  AddressSet addresses(facts.graph.size());
  reach(facts.graph, entries, {true, false}, facts.main_alone, addresses);
  return addresses;
}

}  // namespace

void check_stores(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  const auto stores = [&](const Command& command) { return written_to_eeprom(command, program.module) != nullptr; };
  if (!std::any_of(program.commands.begin(), program.commands.end(), stores)) return;
  const FlowCycles cycles(facts.graph, {true, true});
  const AddressSet again = repeated(facts, cycles);
  for (Address address = 0; address < facts.graph.size(); ++address) {
    const char* const written = written_to_eeprom(facts.graph.command(address), program.module);
    if (written == nullptr || (!cycles.is_on_cycle(address) && !again[address])) continue;
    diagnostics.add(DiagnosticKind::stored_in_loop, program.source_map[address],
                    "this instruction is repeated and writes to the EEPROM each time: " + std::string(written),
                    "an EEPROM wears out; write only what has changed, or once at the end");
  }
}

}  // namespace opentmcl::lang
