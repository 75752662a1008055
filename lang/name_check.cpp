#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lang/program_check.hpp"

namespace opentmcl::lang {
namespace {

/// Names of included files serve several programs, of which each uses some.
constexpr FileId main_file = 0;

/// Takes the label and its colon away.
std::optional<Fix> removal_of(const Symbol& label, const Sources& sources) {
  const std::string_view text = sources[label.span.file].text;
  const std::size_t colon = text.find(':', label.span.offset + label.span.length);
  if (colon == std::string_view::npos) return std::nullopt;
  const auto length = static_cast<std::uint32_t>(colon + 1 - label.span.offset);
  return Fix{{label.span.file, label.span.offset, length}, "", "remove the label"};
}

/// Tells the labels nothing refers to that are of no use from those where the host starts the program.
class UnusedLabels {
 public:
  UnusedLabels(const CheckedProgram& program, const FlowFacts& facts) {
    const FlowGraph& graph = facts.graph;
    std::vector<Address> entries = facts.starts;
    for (const InterruptEntry& entry : facts.interrupts) entries.push_back(entry.routine);
    for (const Symbol& symbol : program.symbols.symbols()) {
      const bool is_entry = symbol.kind == SymbolKind::label && symbol.is_used && symbol.value < graph.size();
      if (is_entry) entries.push_back(static_cast<Address>(symbol.value));
    }
    reached_ = reachable(graph, entries, {true, true});
    AddressSet returns(graph.size());
    bool returns_anywhere = false;
    for (Address address = 0; address < graph.size(); ++address) {
      const Flow flow = graph.flow(address);
      if (flow != Flow::return_from_call && flow != Flow::return_from_interrupt) continue;
      returns[address] = true;
      returns_anywhere = true;
    }
    returning_ = returns_anywhere ? leading_to(graph, returns, AddressSet(graph.size())) : returns;
  }

  /// Why a label nothing refers to is of no use, or nullptr if the host may start the program there.
  const char* reason(Address address) const {
    if (address == 0) return nullptr;
    if (reached_[address]) return "";
    return returning_[address] ? "the routine is never called" : nullptr;
  }

 private:
  AddressSet reached_;    // without the labels in question
  AddressSet returning_;  // leads to a RSUB or RETI
};

void check_unused(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  std::optional<UnusedLabels> labels;
  for (const Symbol& symbol : program.symbols.symbols()) {
    if (symbol.is_used || symbol.span.file != main_file) continue;
    if (symbol.kind == SymbolKind::constant) {
      diagnostics.add(DiagnosticKind::unused_constant, symbol.span,
                      "nothing refers to the constant " + in_quotes(symbol.name));
      continue;
    }
    if (symbol.value >= facts.graph.size()) continue;
    if (!labels) labels.emplace(program, facts);
    const char* const reason = labels->reason(static_cast<Address>(symbol.value));
    if (reason == nullptr) continue;
    diagnostics.add(DiagnosticKind::unused_label, symbol.span, "nothing refers to the label " + in_quotes(symbol.name),
                    reason, {}, removal_of(symbol, program.sources));
  }
}

}  // namespace

void check_names(const CheckedProgram& program, const FlowFacts& facts, DiagnosticList& diagnostics) {
  for (const Symbol& symbol : program.symbols.symbols()) {
    if (symbol.kind != SymbolKind::label || symbol.value < facts.graph.size()) continue;
    diagnostics.add(DiagnosticKind::label_after_end, symbol.span,
                    "no instruction follows the label " + in_quotes(symbol.name));
  }
  check_unused(program, facts, diagnostics);
}

}  // namespace opentmcl::lang
