#include "scenario/problem.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "lang/suggestion.hpp"

namespace opentmcl::scenario {

std::vector<Problem> ProblemList::take_sorted() {
  std::stable_sort(problems_.begin(), problems_.end(), [](const Problem& left, const Problem& right) {
    return std::tie(left.place.line, left.place.column) < std::tie(right.place.line, right.place.column);
  });
  return std::move(problems_);
}

std::string nearest_or_all(std::string_view word, std::span<const std::string_view> known) {
  lang::Suggestion suggestion(word);
  for (const std::string_view name : known) suggestion.consider(name);
  const std::string hint = suggestion.text();
  return hint.empty() ? "expected " + listed(known) : hint;
}

}  // namespace opentmcl::scenario
