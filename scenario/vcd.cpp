#include "scenario/vcd.hpp"

#include <bit>
#include <cstdint>
#include <string_view>

namespace opentmcl::scenario {
namespace {

using Kind = twin::Quantity::Kind;

/// A short name made of printable characters, the first counting least.
std::string identifier(std::size_t signal) {
  constexpr char first = '!';
  constexpr std::size_t base = '~' - '!' + 1;
  std::string text;
  do {
    text += static_cast<char>(first + static_cast<char>(signal % base));
    signal /= base;
  } while (signal > 0);
  return text;
}

std::string binary(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  std::string text;
  for (auto bit = std::bit_width(bits); bit > 1; --bit) text += (bits >> (bit - 1) & 1) != 0 ? '1' : '0';
  text += (bits & 1) != 0 ? '1' : '0';
  return text;
}

std::string declaration(Kind kind, const std::string& code, std::string_view name) {
  const std::string type = kind == Kind::truth ? "wire 1" : kind == Kind::whole ? "integer 64" : "real 64";
  return "$var " + type + ' ' + code + ' ' + std::string(name) + " $end\n";
}

}  // namespace

std::string Vcd::begin(std::span<const RecordedSignal> signals, twin::Tick tick, std::span<const double> values) {
  std::string text = "$timescale 100 ps $end\n$scope module module $end\n";
  kinds_.clear();
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const std::string_view name = signals[i].name;
    // What is only in the trace are words and events: whole numbers.
    kinds_.push_back(signals[i].quantity == nullptr ? Kind::whole : signals[i].quantity->kind);
    const std::size_t dot = name.rfind('.');
    const bool in_scope = dot != std::string_view::npos;
    if (in_scope) text += "$scope module " + std::string(name.substr(0, dot)) + " $end\n";
    text += declaration(kinds_.back(), identifier(i), in_scope ? name.substr(dot + 1) : name);
    if (in_scope) text += "$upscope $end\n";
  }
  text += "$upscope $end\n$enddefinitions $end\n";
  latest_ = tick;
  text += '#' + std::to_string(tick * units_a_tick) + "\n$dumpvars\n";
  for (std::size_t i = 0; i < values.size(); ++i) text += value_change(i, values[i]);
  return text + "$end\n";
}

std::string Vcd::change(twin::Tick tick, std::size_t signal, double value) {
  return time(tick) + value_change(signal, value);
}

std::string Vcd::end(twin::Tick tick) {
  return time(tick);
}

std::string Vcd::time(twin::Tick tick) {
  if (tick == latest_) return {};
  latest_ = tick;
  return '#' + std::to_string(tick * units_a_tick) + '\n';
}

std::string Vcd::value_change(std::size_t signal, double value) const {
  const std::string code = identifier(signal) + '\n';
  switch (kinds_[signal]) {
    case Kind::truth:
      return (value != 0 ? '1' : '0') + code;
    case Kind::whole:
      return 'b' + binary(static_cast<std::int64_t>(value)) + ' ' + code;
    case Kind::real:
      break;
  }
  return 'r' + twin::text_of(value) + ' ' + code;
}

}  // namespace opentmcl::scenario
