#include "scenario/csv.hpp"

namespace opentmcl::scenario {

std::string seconds_text(twin::Tick tick) {
  constexpr twin::Tick ticks_a_second = 16'000'000;
  constexpr twin::Tick units_a_tick = 625;  // of 10^-10 s
  constexpr std::size_t digits = 10;
  std::string fraction = std::to_string(tick % ticks_a_second * units_a_tick);
  fraction.insert(0, digits - fraction.size(), '0');
  while (fraction.size() > 1 && fraction.back() == '0') fraction.pop_back();
  return std::to_string(tick / ticks_a_second) + '.' + fraction;
}

std::string Csv::begin(std::span<const RecordedSignal> signals, twin::Tick tick, std::span<const double> values) {
  std::string text = "time [s]";
  for (const RecordedSignal& signal : signals) {
    text += ',' + signal.name;
    if (signal.quantity != nullptr && !signal.quantity->unit.empty())
      text += " [" + std::string(signal.quantity->unit) + ']';
  }
  tick_ = tick;
  values_.assign(values.begin(), values.end());
  return text + '\n';
}

std::string Csv::change(twin::Tick tick, std::size_t signal, double value) {
  std::string text;
  if (tick != tick_) text = line();
  tick_ = tick;
  values_[signal] = value;
  return text;
}

std::string Csv::end(twin::Tick tick) {
  std::string text = line();
  if (tick != tick_) {
    tick_ = tick;
    text += line();
  }
  return text;
}

std::string Csv::line() const {
  std::string text = seconds_text(tick_);
  for (const double value : values_) text += ',' + twin::text_of(value);
  return text + '\n';
}

}  // namespace opentmcl::scenario
