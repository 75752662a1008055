#include "lang/symbol_table.hpp"

#include <utility>

#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

constexpr std::size_t initial_slots = 512;

/// A quarter of the slots stays free: a fuller table has longer searches, an emptier one more cache misses.
constexpr bool has_room_for(std::size_t symbols, std::size_t slots) {
  return 4 * symbols <= 3 * slots;
}

}  // namespace

SymbolTable::SymbolTable() : slots_(initial_slots) {}

const Symbol* SymbolTable::find(std::string_view name) const {
  const Slot& slot = slots_[slot_of(name, hash_of_name(name))];
  return slot.number == 0 ? nullptr : &symbols_[slot.number - 1];
}

const Symbol* SymbolTable::use(std::string_view name) {
  const Slot& slot = slots_[slot_of(name, hash_of_name(name))];
  if (slot.number == 0) return nullptr;
  Symbol& symbol = symbols_[slot.number - 1];
  symbol.is_used = true;
  return &symbol;
}

const Symbol* SymbolTable::insert(const Symbol& symbol) {
  const std::uint32_t hash = hash_of_name(symbol.name);
  std::size_t at = slot_of(symbol.name, hash);
  if (slots_[at].number != 0) return &symbols_[slots_[at].number - 1];
  if (!has_room_for(symbols_.size() + 1, slots_.size())) {
    resize(2 * slots_.size());
    at = slot_of(symbol.name, hash);
  }
  symbols_.push_back(symbol);
  slots_[at] = {hash, static_cast<std::uint32_t>(symbols_.size())};
  return nullptr;
}

std::size_t SymbolTable::slot_of(std::string_view name, std::uint32_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash & mask;
  while (slots_[at].number != 0 &&
         (slots_[at].hash != hash || !is_same_name(symbols_[slots_[at].number - 1].name, name))) {
    at = (at + 1) & mask;
  }
  return at;
}

void SymbolTable::reserve(std::size_t count) {
  symbols_.reserve(count);
  std::size_t size = slots_.size();
  while (!has_room_for(count, size)) size *= 2;
  if (size != slots_.size()) resize(size);
}

void SymbolTable::resize(std::size_t size) {
  std::vector<Slot> larger(size);
  const std::size_t mask = larger.size() - 1;
  for (const Slot& slot : slots_) {
    if (slot.number == 0) continue;
    std::size_t at = slot.hash & mask;
    while (larger[at].number != 0) at = (at + 1) & mask;
    larger[at] = slot;
  }
  slots_ = std::move(larger);
}

}  // namespace opentmcl::lang
