#include "scenario/unit.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

#include "lang/diagnostic.hpp"
#include "lang/suggestion.hpp"

namespace opentmcl::scenario {
namespace {

constexpr double degrees_in_half_a_turn = 180;
constexpr double pi = 3.14159265358979323846;

constexpr Unit table[] = {
    {"s", Dimension::time, 1'000'000, 1},
    {"us", Dimension::time, 1, 1},
    {"µs", Dimension::time, 1, 1},
    {"ms", Dimension::time, 1'000, 1},
    {"min", Dimension::time, 60e6, 1},
    {"h", Dimension::time, 3600e6, 1},
    {"mm", Dimension::length, 1, 1},
    {"um", Dimension::length, 1, 1'000},
    {"µm", Dimension::length, 1, 1'000},
    {"cm", Dimension::length, 10, 1},
    {"m", Dimension::length, 1'000, 1},
    {"deg", Dimension::angle, 1, 1},
    {"°", Dimension::angle, 1, 1},
    {"rad", Dimension::angle, degrees_in_half_a_turn, pi},
    {"1/s", Dimension::frequency, 1, 1},
    {"Hz", Dimension::frequency, 1, 1},
    {"kHz", Dimension::frequency, 1'000, 1},
    {"V", Dimension::voltage, 1, 1},
    {"mV", Dimension::voltage, 1, 1'000},
    {"A", Dimension::current, 1, 1},
    {"mA", Dimension::current, 1, 1'000},
    {"Ohm", Dimension::resistance, 1, 1},
    {"mOhm", Dimension::resistance, 1, 1'000},
    {"H", Dimension::inductance, 1, 1},
    {"mH", Dimension::inductance, 1, 1'000},
    {"degC", Dimension::temperature, 1, 1},
    {"°C", Dimension::temperature, 1, 1},
    {"N", Dimension::force, 1, 1},
    {"mN", Dimension::force, 1, 1'000},
    {"Nm", Dimension::torque, 1, 1},
    {"N m", Dimension::torque, 1, 1},
    {"mNm", Dimension::torque, 1, 1'000},
    {"mN m", Dimension::torque, 1, 1'000},
    {"Ncm", Dimension::torque, 1, 100},
    {"N cm", Dimension::torque, 1, 100},
    {"kg", Dimension::mass, 1, 1},
    {"g", Dimension::mass, 1, 1'000},
    {"kg m2", Dimension::inertia, 1, 1},
    {"g cm2", Dimension::inertia, 1, 1e7},
    {"N/m", Dimension::stiffness, 1, 1},
    {"N/mm", Dimension::stiffness, 1'000, 1},
    {"Nm/rad", Dimension::torsional_stiffness, 1, 1},
    {"N m/rad", Dimension::torsional_stiffness, 1, 1},
    {"Nm s", Dimension::torsional_damping, 1, 1},
    {"N m s", Dimension::torsional_damping, 1, 1},
    {"rpm", Dimension::rotation_speed, 1, 1},
    {"%", Dimension::share, 1, 1},
};

/// For messages, in the order of the enumeration.
constexpr std::string_view dimension_names[] = {"a time",
                                                "a length",
                                                "an angle",
                                                "a frequency",
                                                "a voltage",
                                                "a current",
                                                "a resistance",
                                                "an inductance",
                                                "a temperature",
                                                "a force",
                                                "a torque",
                                                "a mass",
                                                "an inertia",
                                                "a stiffness",
                                                "a torsional stiffness",
                                                "a torsional damping",
                                                "a rotational speed",
                                                "a share"};

constexpr bool is_space(char letter) {
  return letter == ' ' || letter == '\t';
}

/// A unit that ends in the middle of a word is another unit.
constexpr bool is_word(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
         letter == '/' || static_cast<unsigned char>(letter) >= 0x80;
}

bool begins_with_unit(std::string_view text, const Unit& unit) {
  return text.starts_with(unit.name) && (text.size() == unit.name.size() || !is_word(text[unit.name.size()]));
}

const Unit* longest_unit_at(std::string_view text) {
  const Unit* longest = nullptr;
  for (const Unit& unit : table) {
    if (begins_with_unit(text, unit) && (longest == nullptr || unit.name.size() > longest->name.size()))
      longest = &unit;
  }
  return longest;
}

std::string_view word_at(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size() && is_word(text[length])) ++length;
  return text.substr(0, length);
}

std::string_view name_of(Dimension dimension) {
  return dimension_names[static_cast<std::size_t>(dimension)];
}

std::string wrong_unit(std::string_view word, std::string_view wanted) {
  const std::string found = lang::in_quotes(word);
  const Unit* const unit = find_unit(wanted);
  if (unit == nullptr) return found + " behind a plain number: expected no unit";
  lang::Suggestion suggestion(word);
  for (const Unit& candidate : table) {
    if (candidate.dimension == unit->dimension) suggestion.consider(candidate.name);
  }
  // Another unit is no slip of the finger.
  const std::string hint = find_unit(word) == nullptr ? suggestion.text() : "";
  return found + " is not the unit of " + std::string(name_of(unit->dimension)) + ": expected " +
         expected_number(wanted) + (hint.empty() ? "" : "; " + hint);
}

}  // namespace

std::span<const Unit> units() {
  return table;
}

const Unit* find_unit(std::string_view name) {
  for (const Unit& unit : table) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

std::string expected_number(std::string_view unit) {
  const Unit* const found = find_unit(unit);
  if (found == nullptr) return "a number";
  return std::string(name_of(found->dimension)) + " such as 1.5 " + std::string(unit);
}

Parsed<NumberWithUnit> take_number(std::string_view text, std::string_view unit) {
  double value = 0;
  const char* const begin = text.data();
  const auto [end, error] = std::from_chars(begin, begin + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) {
    const std::string_view word = word_at(text);
    const std::string found = text.empty() ? "nothing" : lang::in_quotes(word.empty() ? text.substr(0, 1) : word);
    return TextError{0, "expected " + expected_number(unit) + ", found " + found};
  }
  auto length = static_cast<std::size_t>(end - begin);
  std::size_t unit_begin = length;
  while (unit_begin < text.size() && is_space(text[unit_begin])) ++unit_begin;
  const std::string_view rest = text.substr(unit_begin);
  const Unit* const given = longest_unit_at(rest);
  const Unit* const wanted = find_unit(unit);
  if (given != nullptr && wanted != nullptr && given->dimension == wanted->dimension) {
    length = unit_begin + given->name.size();
    value = value * (given->numerator * wanted->denominator) / (given->denominator * wanted->numerator);
    return NumberWithUnit{value, length};
  }
  const bool joined = unit_begin == length && !rest.empty() && is_word(rest.front());
  if (given != nullptr || joined) return TextError{unit_begin, wrong_unit(word_at(rest), unit)};
  return NumberWithUnit{value, length};
}

Parsed<double> parse_number(std::string_view text, std::string_view unit) {
  const Parsed<NumberWithUnit> taken = take_number(text, unit);
  if (const auto* const error = std::get_if<TextError>(&taken)) return *error;
  const auto& number = std::get<NumberWithUnit>(taken);
  std::size_t rest = number.length;
  while (rest < text.size() && is_space(text[rest])) ++rest;
  if (rest == text.size()) return number.value;
  return TextError{rest, wrong_unit(text.substr(rest), unit)};
}

}  // namespace opentmcl::scenario
