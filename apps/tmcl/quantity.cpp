#include "apps/tmcl/quantity.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "server/pace.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

struct TimeUnit {
  std::string_view name;
  double microseconds;
};

constexpr TimeUnit time_units[] = {{"us", 1}, {"ms", 1e3}, {"s", 1e6}, {"min", 60e6}, {"h", 3600e6}};

/// More than a century: no sum of two such times overflows.
constexpr double longest_duration = 1e16;

struct Number {
  double value;
  std::string_view rest;
};

std::optional<Number> take_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  return Number{value, text.substr(static_cast<std::size_t>(end - text.data()))};
}

}  // namespace

Result<Microseconds> parse_duration(std::string_view text) {
  if (const std::optional<Number> number = take_number(text)) {
    for (const TimeUnit& unit : time_units) {
      const double duration = number->value * unit.microseconds;
      if (number->rest == unit.name && duration >= 0 && duration <= longest_duration) {
        return static_cast<Microseconds>(std::llround(duration));
      }
    }
  }
  return Error{ErrorKind::usage,
               fmt::format("\"{}\" is no duration: expected a number and us, ms, s, min or h, as in 500ms", text),
               {}};
}

Result<double> parse_speed(std::string_view text) {
  if (text == "max") return server::Pace::maximum;
  const std::optional<Number> number = take_number(text);
  if (number && number->rest.empty() && number->value > 0) return number->value;
  return Error{ErrorKind::usage, fmt::format("\"{}\" is no speed: expected a number greater than 0, or max", text), {}};
}

}  // namespace opentmcl::app
