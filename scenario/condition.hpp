// What an event waits for and what is expected: "position > 40000 and not left_switch".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/text_error.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::scenario {

enum class Relation : std::uint8_t { less, at_most, equal, unequal, at_least, greater };

/// A quantity against a number or another quantity.
struct Comparison {
  const twin::Quantity* left;
  Relation relation;
  const twin::Quantity* right;  ///< nullptr: `number`
  double number = 0;            ///< in the unit of `left`
  double tolerance = 0;         ///< how far apart equal values may be, in that unit
  std::size_t offset = 0;       ///< of `left` in the text

  bool holds(const twin::World& world) const;
};

/// Comparisons joined by "and" and "or"; "and" binds more closely. There are no parentheses.
struct Condition {
  std::string text;
  /// One of them must hold; each holds when all its comparisons do.
  std::vector<std::vector<Comparison>> alternatives;

  bool holds(const twin::World& world) const;

  /// The present values of the quantities in it: "position is 39120, left_switch is 0".
  std::string values(const twin::World& world) const;
};

/// A comparison is
///  * QUANTITY RELATION NUMBER [UNIT], with one of < <= = != >= > (and == for =);
///  * QUANTITY RELATION QUANTITY, of the same unit;
///  * either of them with "within NUMBER [UNIT]" behind =;
///  * QUANTITY or not QUANTITY, for truths.
Parsed<Condition> parse_condition(std::string_view text);

/// "supply_voltage is 24 V".
std::string value_text(const twin::Quantity& quantity, const twin::World& world);

/// "there is no quantity 'positoin': did you mean position?"
std::string no_such_quantity(std::string_view name);

}  // namespace opentmcl::scenario
