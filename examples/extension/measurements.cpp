#include "examples/extension/measurements.hpp"

namespace opentmcl::examples {

namespace {

Outcome done(std::int32_t value) {
  return {Status::ok, value, Outcome::Form::normal};
}

/// In a program the value goes to the accumulator.
Outcome result(std::int32_t value) {
  return {Status::ok, value, Outcome::Form::result};
}

Outcome no_such_range(const Command& command) {
  return {Status::wrong_type, command.value, Outcome::Form::normal};
}

}  // namespace

Extensions Measurements::extensions() {
  Extensions extensions;
  extensions.context = this;
  extensions.user_functions[0] = sum;
  extensions.user_functions[1] = maximum;
  extensions.user_functions[2] = fill;
  extensions.get_variable = get;
  extensions.set_variable = set;
  return extensions;
}

/// Wraps at 32 bits, as all arithmetic of TMCL.
Outcome Measurements::sum(void* context, const Command& command) {
  if (!is_range(command)) return no_such_range(command);
  std::uint32_t total = 0;
  for (unsigned n = command.type; n <= command.motor; ++n)
    total += static_cast<std::uint32_t>(self(context).values_[n]);
  return result(static_cast<std::int32_t>(total));
}

Outcome Measurements::maximum(void* context, const Command& command) {
  if (!is_range(command)) return no_such_range(command);
  std::int32_t largest = self(context).values_[command.type];
  for (unsigned n = command.type; n <= command.motor; ++n) {
    if (self(context).values_[n] > largest) largest = self(context).values_[n];
  }
  return result(largest);
}

Outcome Measurements::fill(void* context, const Command& command) {
  if (!is_range(command)) return no_such_range(command);
  for (unsigned n = command.type; n <= command.motor; ++n) self(context).values_[n] = command.value;
  return done(command.value);
}

Status Measurements::get(void* context, std::uint8_t number, std::int32_t& value) {
  if (number >= count) return Status::wrong_type;
  value = self(context).values_[number];
  return Status::ok;
}

Status Measurements::set(void* context, std::uint8_t number, std::int32_t value) {
  if (number >= count) return Status::wrong_type;
  self(context).values_[number] = value;
  return Status::ok;
}

}  // namespace opentmcl::examples
