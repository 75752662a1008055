#include "scenario/recorder.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "lang/diagnostic.hpp"
#include "lang/suggestion.hpp"
#include "scenario/csv.hpp"
#include "scenario/vcd.hpp"

namespace opentmcl::scenario {

Recorder::Recorder(const Recording& recording, std::unique_ptr<RecordingFormat> format, Sink sink)
    : every_(recording.every),
      exact_(recording.exact),
      when_(recording.when),
      before_(recording.before * twin::ticks_per_microsecond),
      format_(std::move(format)),
      sink_(std::move(sink)) {
  for (const std::string& name : recording.signals) signals_.push_back({name, twin::find_quantity(name)});
}

void Recorder::start(const VirtualModule& module) {
  const twin::World& world = module.world();
  begin_ = world.now();
  for (const RecordedSignal& signal : signals_) {
    noted_.push_back(signal.quantity == nullptr ? 0 : signal.quantity->read(world));
    is_sampled_.push_back(signal.quantity != nullptr && !(exact_ && signal.quantity->is_traced_in(world)));
  }
  written_ = noted_;
  running_ = true;
  next_look_ = module.now();
}

void Recorder::act(VirtualModule& module) {
  look(module.world());
  const twin::Tick tick = module.world().now() - begin_;
  if (!triggered_ && (!when_ || when_->holds(module.world()))) trigger(tick);
  if (triggered_) {
    write_changes();
  } else {
    forget_until(tick < before_ ? 0 : tick - before_);
  }
  while (next_look_ <= module.now()) next_look_ += every_;
}

void Recorder::finish(const VirtualModule& module) {
  look(module.world());
  if (triggered_) {
    write_changes();
    sink_(format_->end(module.world().now() - begin_));
  }
  running_ = false;
  next_look_ = never;
}

void Recorder::changed(twin::Tick tick, std::string_view signal, std::int64_t value) {
  if (!running_) return;
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (signals_[i].name != signal || is_sampled_[i]) continue;
    const bool is_event = signals_[i].quantity == nullptr;
    const double scale = is_event ? 1 : signals_[i].quantity->trace_scale;
    if (is_event) noted_[i] = static_cast<double>(value);
    if (is_event) changes_.push_back({tick - begin_, i, noted_[i]});
    if (!is_event) note(tick - begin_, i, static_cast<double>(value) / scale);
  }
}

void Recorder::look(const twin::World& world) {
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (is_sampled_[i]) note(world.now() - begin_, i, signals_[i].quantity->read(world));
  }
}

void Recorder::note(twin::Tick tick, std::size_t signal, double value) {
  if (noted_[signal] == value) return;
  noted_[signal] = value;
  changes_.push_back({tick, signal, value});
}

void Recorder::trigger(twin::Tick tick) {
  triggered_ = true;
  const twin::Tick first = tick < before_ ? 0 : tick - before_;
  forget_until(first);
  sink_(format_->begin(signals_, first, written_));
}

/// The signals of one tick are reported in an order that depends on who moved them; what is written does not.
void Recorder::sort_changes() {
  std::stable_sort(changes_.begin(), changes_.end(), [](const Change& left, const Change& right) {
    return std::tie(left.tick, left.signal) < std::tie(right.tick, right.signal);
  });
}

void Recorder::write_changes() {
  sort_changes();
  std::string text;
  for (const Change& change : changes_) text += format_->change(change.tick, change.signal, change.value);
  changes_.clear();
  if (!text.empty()) sink_(text);
}

void Recorder::forget_until(twin::Tick tick) {
  sort_changes();
  const auto first =
      std::find_if(changes_.begin(), changes_.end(), [tick](const Change& change) { return change.tick > tick; });
  for (auto change = changes_.begin(); change != first; ++change) written_[change->signal] = change->value;
  changes_.erase(changes_.begin(), first);
}

std::optional<std::string> objection_to_signal(std::string_view name, const twin::World& world) {
  if (const twin::Quantity* const quantity = twin::find_quantity(name)) {
    const auto reason = twin::absence(*quantity, world);
    return reason ? std::optional(std::string(name) + ' ' + *reason) : std::nullopt;
  }
  lang::Suggestion suggestion(name);
  for (const twin::TraceOnlySignal& signal : twin::trace_only_signals()) {
    if (signal.name == name) return std::nullopt;
    suggestion.consider(signal.name);
  }
  for (const twin::Quantity& quantity : twin::quantities()) suggestion.consider(quantity.name);
  const std::string hint = suggestion.text();
  return "there is no signal " + lang::in_quotes(name) + (hint.empty() ? "" : ": " + hint);
}

std::unique_ptr<RecordingFormat> recording_format_of(std::string_view file_name) {
  if (file_name.ends_with(".vcd")) return std::make_unique<Vcd>();
  if (file_name.ends_with(".csv")) return std::make_unique<Csv>();
  return nullptr;
}

}  // namespace opentmcl::scenario
