#include "lang/suggestion.hpp"

#include <algorithm>
#include <vector>

#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

/// Longer names are compared by their beginning, so that a hostile source cannot make a comparison slow.
constexpr std::size_t compared_length = 64;

}  // namespace

Suggestion::Suggestion(std::string_view wrong)
    : wrong_(wrong), best_distance_(std::max<std::size_t>(1, std::min(wrong.size(), compared_length) / 3) + 1) {}

void Suggestion::consider(std::string_view candidate) {
  const std::size_t distance = edit_distance(wrong_, candidate, best_distance_ - 1);
  if (distance >= best_distance_) return;
  best_distance_ = distance;
  best_ = candidate;
}

std::string Suggestion::text() const {
  return best_.empty() ? "" : "did you mean " + std::string(best_) + "?";
}

std::optional<Fix> fix_of(const Suggestion& suggestion, Span wrong) {
  if (suggestion.name().empty()) return std::nullopt;
  const std::string name(suggestion.name());
  return Fix{wrong, name, "change to " + name};
}

std::size_t edit_distance(std::string_view left, std::string_view right, std::size_t limit) {
  left = left.substr(0, compared_length);
  right = right.substr(0, compared_length);
  const std::size_t difference = left.size() > right.size() ? left.size() - right.size() : right.size() - left.size();
  if (difference > limit) return limit + 1;

  // Rows of the usual table of distances between beginnings of both names: the present one and the two above it.
  std::vector<std::size_t> two_above(right.size() + 1);
  std::vector<std::size_t> above(right.size() + 1);
  std::vector<std::size_t> row(right.size() + 1);
  for (std::size_t k = 0; k <= right.size(); ++k) row[k] = k;
  for (std::size_t i = 1; i <= left.size(); ++i) {
    std::swap(two_above, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t k = 1; k <= right.size(); ++k) {
      const bool same = to_upper(left[i - 1]) == to_upper(right[k - 1]);
      row[k] = std::min({above[k] + 1, row[k - 1] + 1, above[k - 1] + (same ? 0U : 1U)});
      const bool swapped = i > 1 && k > 1 && to_upper(left[i - 1]) == to_upper(right[k - 2]) &&
                           to_upper(left[i - 2]) == to_upper(right[k - 1]);
      if (swapped) row[k] = std::min(row[k], two_above[k - 2] + 1);
    }
  }
  return std::min(row[right.size()], limit + 1);
}

}  // namespace opentmcl::lang
