#include "apps/tmcl/parameter_name.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <vector>

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// What is left when everything that does not matter is gone.
std::string simplified(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == ' ' || c == '-' || c == '_') continue;
    result += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return result;
}

std::optional<std::uint8_t> number_in(std::string_view text) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number > 255) return std::nullopt;
  return static_cast<std::uint8_t>(number);
}

NamedParameter named(const AxisParameterSpec& row) {
  return {static_cast<std::uint8_t>(row.number), row.symbol, row.name, row.unit};
}
NamedParameter named(const GlobalParameterSpec& row) {
  return {static_cast<std::uint8_t>(row.number), row.symbol, row.name, row.unit};
}
NamedParameter named(const InterruptSpec& row) {
  const bool is_time = row.setting == InterruptSetting::period;
  return {static_cast<std::uint8_t>(row.number), row.symbol, row.name, is_time ? Unit::milliseconds : Unit::none};
}

/// @param prefix that symbols begin with and users may leave out, such as "ap"
Result<NamedParameter> find(std::string_view text, const std::vector<NamedParameter>& rows, std::string_view prefix) {
  if (const std::optional<std::uint8_t> number = number_in(text)) {
    for (const NamedParameter& row : rows) {
      if (row.number == *number) return row;
    }
    return NamedParameter{*number};
  }
  const std::string wanted = simplified(text);
  std::string similar;
  for (const NamedParameter& row : rows) {
    const std::string symbol = simplified(row.symbol);
    const std::string name = simplified(row.name);
    if (wanted == name || wanted == symbol || std::string(prefix) + wanted == symbol) return row;
    if (!wanted.empty() && (name.find(wanted) != std::string::npos || symbol.find(wanted) != std::string::npos)) {
      similar += fmt::format("{}{}", similar.empty() ? "; similar: " : ", ", row.symbol);
    }
  }
  return Error{ErrorKind::usage,
               fmt::format("no parameter \"{}\": expected a number from 0 to 255 or a name that `tmcl spec` lists{}",
                           text, similar),
               {}};
}

template <class Row, std::size_t count>
std::vector<NamedParameter> all(const Row (&table)[count]) {
  std::vector<NamedParameter> rows;
  for (const Row& row : table) rows.push_back(named(row));
  return rows;
}

}  // namespace

Result<NamedParameter> find_axis_parameter(std::string_view text) {
  return find(text, all(axis_parameters), "ap");
}

Result<NamedParameter> find_global_parameter(std::string_view text, Bank bank) {
  switch (bank) {
    case Bank::module_settings:
      return find(text, all(global_parameters), "gp");
    case Bank::interrupt_settings:
      return find(text, all(interrupts), "ti");
    case Bank::customer:
    case Bank::user_variables:
      break;
  }
  return find(text, {}, "");
}

}  // namespace opentmcl::app
