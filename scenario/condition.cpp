#include "scenario/condition.hpp"

#include <algorithm>
#include <cmath>

#include "lang/diagnostic.hpp"
#include "lang/suggestion.hpp"
#include "scenario/unit.hpp"

namespace opentmcl::scenario {
namespace {

struct RelationSign {
  std::string_view text;
  Relation relation;
};

/// A sign that begins with another one stands before it.
constexpr RelationSign signs[] = {{"<=", Relation::at_most}, {">=", Relation::at_least}, {"==", Relation::equal},
                                  {"!=", Relation::unequal}, {"<", Relation::less},      {">", Relation::greater},
                                  {"=", Relation::equal}};

/// Values that were computed differently are equal when they agree in nine digits.
constexpr double rounding = 1e-9;

constexpr bool is_name_letter(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
         letter == '_' || letter == '.';
}

/// Reads a condition from left to right. A function that fails leaves the error behind and returns false.
class ConditionParser {
 public:
  explicit ConditionParser(std::string_view text) : text_(text) {}

  Parsed<Condition> parse() {
    Condition condition{std::string(text_), {{}}};
    while (true) {
      if (!comparison(condition.alternatives.back().emplace_back())) return error_;
      const std::size_t begin = skip_spaces();
      if (begin == text_.size()) return condition;
      const std::string_view word = name();
      if (word == "or") {
        condition.alternatives.emplace_back();
      } else if (word != "and") {
        return TextError{begin, "expected 'and', 'or' or the end, found " + found_at(begin)};
      }
    }
  }

 private:
  bool comparison(Comparison& result) {
    std::size_t begin = skip_spaces();
    std::string_view word = name();
    const bool negated = word == "not";
    if (negated) {
      begin = skip_spaces();
      word = name();
    }
    result.offset = begin;
    result.left = quantity(begin, word);
    if (result.left == nullptr) return false;
    const std::size_t sign_begin = skip_spaces();
    const std::string_view written = rest().substr(0, rest().find_first_not_of("<>=!"));
    if (written.empty()) return truth(result, negated, sign_begin);
    const RelationSign* const found = std::find_if(
        std::begin(signs), std::end(signs), [written](const RelationSign& sign) { return sign.text == written; });
    if (found == std::end(signs))
      return fail(sign_begin, "expected < <= = != >= or >, found " + lang::in_quotes(written));
    if (negated) return fail(sign_begin, "'not' only stands before a truth, not before a comparison");
    place_ += written.size();
    result.relation = found->relation;
    return right_side(result) && tolerance(result);
  }

  bool truth(Comparison& result, bool negated, std::size_t sign_begin) {
    if (result.left->kind != twin::Quantity::Kind::truth) {
      return fail(sign_begin, "expected < <= = != >= or > behind " + std::string(result.left->name) + ", found " +
                                  found_at(sign_begin));
    }
    result.relation = negated ? Relation::equal : Relation::unequal;
    result.right = nullptr;
    return true;
  }

  bool right_side(Comparison& result) {
    const std::size_t begin = skip_spaces();
    const bool is_name = !rest().empty() && ((rest().front() >= 'a' && rest().front() <= 'z') || rest().front() == '_');
    if (!is_name) {
      result.right = nullptr;
      return number(result.left->unit, result.number);
    }
    result.right = quantity(begin, name());
    if (result.right == nullptr) return false;
    if (result.right->unit == result.left->unit) return true;
    return fail(begin, unit_of(*result.right) + " cannot be compared with " + unit_of(*result.left));
  }

  bool tolerance(Comparison& result) {
    const std::size_t begin = skip_spaces();
    const std::size_t before = place_;
    if (name() != "within") {
      place_ = before;
      return true;
    }
    if (result.relation != Relation::equal) return fail(begin, "'within' only stands behind =");
    const std::size_t number_begin = skip_spaces();
    if (!number(result.left->unit, result.tolerance)) return false;
    return result.tolerance >= 0 || fail(number_begin, "expected a tolerance that is not negative");
  }

  bool number(std::string_view unit, double& value) {
    const Parsed<NumberWithUnit> taken = take_number(rest(), unit);
    if (const auto* const error = std::get_if<TextError>(&taken)) return fail(place_ + error->offset, error->message);
    value = std::get<NumberWithUnit>(taken).value;
    place_ += std::get<NumberWithUnit>(taken).length;
    return true;
  }

  const twin::Quantity* quantity(std::size_t begin, std::string_view word) {
    if (word.empty()) {
      fail(begin, "expected the name of a quantity, found " + found_at(begin));
      return nullptr;
    }
    const twin::Quantity* const found = twin::find_quantity(word);
    if (found == nullptr) fail(begin, no_such_quantity(word));
    return found;
  }

  static std::string unit_of(const twin::Quantity& quantity) {
    return std::string(quantity.name) +
           (quantity.unit.empty() ? " without a unit" : " in " + std::string(quantity.unit));
  }

  std::string found_at(std::size_t begin) const {
    return begin >= text_.size() ? "the end" : lang::in_quotes(text_.substr(begin, text_.find(' ', begin) - begin));
  }

  std::string_view rest() const { return text_.substr(place_); }

  std::size_t skip_spaces() {
    while (place_ < text_.size() && (text_[place_] == ' ' || text_[place_] == '\t')) ++place_;
    return place_;
  }

  std::string_view name() {
    const std::size_t begin = place_;
    while (place_ < text_.size() && is_name_letter(text_[place_])) ++place_;
    return text_.substr(begin, place_ - begin);
  }

  bool fail(std::size_t offset, std::string message) {
    error_ = {offset, std::move(message)};
    return false;
  }

  std::string_view text_;
  std::size_t place_ = 0;
  TextError error_{};
};

}  // namespace

bool Comparison::holds(const twin::World& world) const {
  const double value = left->read(world);
  const double other = right == nullptr ? number : right->read(world);
  const double margin = tolerance + rounding * std::max(std::abs(value), std::abs(other));
  const bool same = std::abs(value - other) <= margin;
  switch (relation) {
    case Relation::less:
      return value < other && !same;
    case Relation::at_most:
      return value <= other || same;
    case Relation::equal:
      return same;
    case Relation::unequal:
      return !same;
    case Relation::at_least:
      return value >= other || same;
    case Relation::greater:
      return value > other && !same;
  }
  return false;
}

bool Condition::holds(const twin::World& world) const {
  return std::any_of(alternatives.begin(), alternatives.end(), [&world](const auto& all) {
    return std::all_of(all.begin(), all.end(), [&world](const Comparison& one) { return one.holds(world); });
  });
}

std::string Condition::values(const twin::World& world) const {
  std::vector<const twin::Quantity*> named;
  std::string listed;
  const auto name = [&](const twin::Quantity* quantity) {
    if (quantity == nullptr || std::find(named.begin(), named.end(), quantity) != named.end()) return;
    named.push_back(quantity);
    listed += (listed.empty() ? "" : ", ") + value_text(*quantity, world);
  };
  for (const auto& all : alternatives) {
    for (const Comparison& one : all) {
      name(one.left);
      name(one.right);
    }
  }
  return listed;
}

Parsed<Condition> parse_condition(std::string_view text) {
  return ConditionParser(text).parse();
}

std::string value_text(const twin::Quantity& quantity, const twin::World& world) {
  const std::string unit = quantity.unit.empty() ? "" : ' ' + std::string(quantity.unit);
  return std::string(quantity.name) + " is " + twin::text_of(quantity.read(world)) + unit;
}

std::string no_such_quantity(std::string_view name) {
  lang::Suggestion suggestion(name);
  for (const twin::Quantity& quantity : twin::quantities()) suggestion.consider(quantity.name);
  const std::string hint = suggestion.text();
  return "there is no quantity " + lang::in_quotes(name) + (hint.empty() ? "" : ": " + hint);
}

}  // namespace opentmcl::scenario
