#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lang/source.hpp"

namespace opentmcl::lang {

enum class SymbolKind : std::uint8_t { constant, label };

struct Symbol {
  std::string_view name;  ///< as written where it is defined; the text must outlive the table
  SymbolKind kind = SymbolKind::constant;
  double value = 0;  ///< of a label its address
  Span span;         ///< where it is defined
  bool is_used = false;
};

/// Constants and labels by name, ignoring case. They share one set of names. Open addressing: one lookup touches the
/// slot and, if the hash agrees, the symbol.
class SymbolTable {
 public:
  SymbolTable();

  /// Makes room for so many symbols, which saves large sources from growing the table again and again.
  void reserve(std::size_t count);

  /// Symbols in the order of their definition.
  const std::vector<Symbol>& symbols() const { return symbols_; }

  /// The symbol of this name, or nullptr. Valid until the next `insert`.
  const Symbol* find(std::string_view name) const;
  /// As `find`, and the symbol is one that something refers to.
  const Symbol* use(std::string_view name);
  /// Adds a symbol unless the name is taken. Returns the one that has the name already, or nullptr if it was added.
  const Symbol* insert(const Symbol& symbol);

 private:
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t number = 0;  // index into symbols_ plus 1; 0: free
  };

  /// The slot of this name, or the free one where it belongs.
  std::size_t slot_of(std::string_view name, std::uint32_t hash) const;
  void resize(std::size_t size);

  std::vector<Symbol> symbols_;
  std::vector<Slot> slots_;  // their number is a power of two
};

}  // namespace opentmcl::lang
