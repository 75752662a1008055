#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "lang/diagnostic.hpp"
#include "lang/source.hpp"

namespace opentmcl::lang {

/// Looks for the name the user most likely meant: the candidate with the fewest letters missing, surplus, wrong or
/// swapped, if these are at most a third of the name.
class Suggestion {
 public:
  explicit Suggestion(std::string_view wrong);

  void consider(std::string_view candidate);
  /// The candidate, or nothing if none is close.
  std::string_view name() const { return best_; }
  /// "did you mean NAME?", or nothing if no candidate is close.
  std::string text() const;

 private:
  std::string_view wrong_;
  std::string_view best_;
  std::size_t best_distance_;
};

/// Writes the suggestion in place of `wrong`; nothing if there is none.
std::optional<Fix> fix_of(const Suggestion& suggestion, Span wrong);

/// Number of single-letter edits and swaps of neighbours between two names, ignoring case; anything above `limit` is
/// reported as limit + 1.
std::size_t edit_distance(std::string_view left, std::string_view right, std::size_t limit);

}  // namespace opentmcl::lang
