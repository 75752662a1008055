// Warnings of what only the whole program shows: instructions nothing reaches, routines without an end, names nobody
// uses. What a program means that is started somewhere by the host: docs/decisions/0060-entries-of-a-program.md.
#pragma once

#include <string>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/diagnostic.hpp"
#include "lang/flow_graph.hpp"
#include "lang/source.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

/// What the assembler knows of a program without errors. All of it must outlive the checks.
struct CheckedProgram {
  const std::vector<Command>& commands;
  const std::vector<Span>& source_map;  ///< empty span: the STOP that was appended
  const SymbolTable& symbols;
  const Sources& sources;
  const ModuleDescription& module;
};

/// Runs all checks.
void check_program(const CheckedProgram& program, DiagnosticList& diagnostics);

/// An instruction that sets an interrupt routine, and where that begins.
struct InterruptEntry {
  Address vect;
  Address routine;
};

/// Everything the checks have in common.
struct FlowFacts {
  explicit FlowFacts(const CheckedProgram& program);

  FlowGraph graph;
  std::vector<InterruptEntry> interrupts;  ///< by VECT, without those that lead out of the program
  /// Where the module begins, or the host may: address 0 and rows of jump tables.
  std::vector<Address> starts;
  AddressSet main_alone;  ///< from the starts, without the subroutines that are called
  AddressSet main;        ///< with them
  AddressSet interrupt;   ///< run in interrupt routines, subroutines they call among them
};

/// Whether an address is that of the STOP nobody wrote.
inline bool is_appended(const CheckedProgram& program, Address address) {
  return program.source_map[address].length == 0;
}

// The checks; each looks after the program as far as it can without recursion, in time proportional to its size.

/// `jump-outside-program`, `no-stop-at-end`, `unreachable-code`
void check_reachability(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics);
/// `subroutines-nested-too-deep`, `recursive-subroutine`, `return-without-call`
void check_subroutines(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics);
/// `interrupt-without-return`, `interrupt-entered-directly`, `endless-wait-in-interrupt`
void check_interrupts(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics);
/// `stored-in-loop`
void check_stores(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics);
/// `label-after-end`, `unused-label`, `unused-constant`
void check_names(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics);

}  // namespace opentmcl::lang
