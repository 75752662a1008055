#pragma once

#include <cstddef>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace opentmcl::scenario {

struct Problem {
  Place place;
  std::string message;  ///< what is wrong, what was expected, and the nearest name if there is one
};

/// The problems of one file.
class ProblemList {
 public:
  void complain(Place place, std::string message) { problems_.push_back({place, std::move(message)}); }
  std::size_t size() const { return problems_.size(); }
  /// In the order of their places.
  std::vector<Problem> take_sorted();

 private:
  std::vector<Problem> problems_;
};

/// "a, b or c": what a message says was expected.
template <class Names>
std::string listed(const Names& names) {
  std::string text;
  std::size_t left = std::size(names);
  for (const auto& name : names) {
    text += text.empty() ? "" : left == 1 ? " or " : ", ";
    text += name;
    --left;
  }
  return text;
}

/// "did you mean kind?", or "expected a, b or c" when none is close.
std::string nearest_or_all(std::string_view word, std::span<const std::string_view> known);

}  // namespace opentmcl::scenario
