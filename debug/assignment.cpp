#include "debug/assignment.hpp"

#include <cmath>
#include <string>

#include "debug/mistake.hpp"
#include "debug/typed_text.hpp"
#include "firmware/spec/global_parameters.hpp"
#include "lang/diagnostic.hpp"
#include "lang/names.hpp"

namespace opentmcl::debug {

using client::Result;

namespace {

/// What can be read and also be set: the name of the read, and the instruction that sets it.
struct Settable {
  std::string_view read;
  std::string_view write;
};
constexpr Settable settables[] = {{"GAP", "SAP"}, {"GGP", "SGP"}, {"GIO", "SIO"}};

bool is_number_of_32_bits(double value) {
  return value == std::trunc(value) && value >= int32_minimum && value <= int32_maximum;
}

Result<void> assign_variable(Engine& engine, std::string_view number_text, std::int32_t value) {
  const Result<double> number = engine.evaluate(number_text);
  if (!number) return number.error();
  constexpr double last_variable = user_variable_count - 1;
  if (*number < 0 || *number > last_variable || *number != std::trunc(*number)) {
    return mistake("there is no user variable " + value_text(*number) + ": they go from 0 to " +
                   value_text(last_variable));
  }
  return engine.set_variable(static_cast<std::uint8_t>(*number), value);
}

}  // namespace

Result<void> assign(Engine& engine, std::string_view subject, double value) {
  subject = trimmed(subject);
  const std::size_t open = subject.find('(');
  const bool is_read = open != std::string_view::npos && subject.ends_with(')');
  const std::string_view name = trimmed(subject.substr(0, open));
  const bool is_register =
      !is_read && (lang::equal_ignoring_case(subject, "A") || lang::equal_ignoring_case(subject, "X"));
  if (!is_read && !is_register) {
    if (TwinPowers* const twin = engine.target().twin()) return twin->set_quantity(subject, value);
    return mistake("expected A, X, VAR(number), GAP(parameter, motor), GGP(parameter, bank) or GIO(port, bank), not " +
                   lang::in_quotes(subject));
  }
  if (!is_number_of_32_bits(value)) return mistake("expected a whole number of 32 bits, not " + value_text(value));
  const auto number = static_cast<std::int32_t>(value);
  if (is_register) {
    return lang::equal_ignoring_case(subject, "A") ? engine.set_accumulator(number) : engine.set_x(number);
  }
  const std::string_view inside = subject.substr(open + 1, subject.size() - open - 2);
  if (lang::equal_ignoring_case(name, "VAR")) return assign_variable(engine, inside, number);
  for (const Settable& settable : settables) {
    if (!lang::equal_ignoring_case(name, settable.read)) continue;
    const bool has_both = inside.find(',') != std::string_view::npos;
    const Result<std::int32_t> set = engine.execute(std::string(settable.write)
                                                        .append(" ")
                                                        .append(inside)
                                                        .append(has_both ? ", " : ", 0, ")
                                                        .append(std::to_string(number)));
    if (!set) return set.error();
    return {};
  }
  return mistake(lang::in_quotes(name) + " cannot be set");
}

}  // namespace opentmcl::debug
