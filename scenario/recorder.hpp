// Writes down how signals change.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "scenario/condition.hpp"
#include "scenario/recording_format.hpp"
#include "scenario/scenario.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl::scenario {

/// Records from start() to finish(), in simulated time alone: equal runs give equal bytes, at every speed.
///
/// A signal that is in the trace is recorded at each tick at which it changes. All others are looked at in regular
/// intervals from the begin on: what a real motor moves, for one, and with Recording::exact off those that are in the
/// trace too. Words and events that
/// are only in the trace are always recorded.
class Recorder final : public twin::TraceObserver, public BenchActor {
 public:
  using Sink = std::function<void(std::string_view text)>;

  /// @param recording its file is not opened here; all signals must exist, see objection_to_signal()
  /// @param sink takes the text piece by piece; must not call back
  Recorder(const Recording& recording, std::unique_ptr<RecordingFormat> format, Sink sink);

  /// The run begins: time 0 of the recording is now. Then add this to the module as an actor, after those who change
  /// something.
  void start(const VirtualModule& module);
  /// The run is over. Nothing is recorded after that.
  void finish(const VirtualModule& module);
  /// The condition to record has held.
  bool is_triggered() const { return triggered_; }

  void changed(twin::Tick tick, std::string_view signal, std::int64_t value) override;
  Microseconds next_act() const override { return next_look_; }
  void act(VirtualModule& module) override;

 private:
  struct Change {
    twin::Tick tick;
    std::size_t signal;
    double value;
  };

  void look(const twin::World& world);
  void note(twin::Tick tick, std::size_t signal, double value);
  void trigger(twin::Tick tick);
  void write_changes();
  void forget_until(twin::Tick tick);
  void sort_changes();

  std::vector<RecordedSignal> signals_;
  Microseconds every_;
  bool exact_;
  std::optional<Condition> when_;
  twin::Tick before_;
  std::unique_ptr<RecordingFormat> format_;
  Sink sink_;
  Microseconds next_look_ = never;
  twin::Tick begin_ = 0;
  bool running_ = false;
  bool triggered_ = false;
  std::vector<bool> is_sampled_;  ///< of each signal: looked at in intervals, in place of what the trace says
  std::vector<double> noted_;     ///< latest value of each signal
  std::vector<double> written_;   ///< the same without `changes_`
  std::vector<Change> changes_;   ///< not written yet
};

/// Why a signal of this name cannot be recorded, or nothing.
std::optional<std::string> objection_to_signal(std::string_view name, const twin::World& world);

/// For a file whose name ends in .vcd or .csv; nullptr for another one.
std::unique_ptr<RecordingFormat> recording_format_of(std::string_view file_name);

}  // namespace opentmcl::scenario
