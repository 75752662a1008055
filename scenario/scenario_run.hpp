// Lets a scenario happen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "scenario/scenario.hpp"

namespace opentmcl::scenario {

/// What a scenario has to say while it runs.
struct Report {
  enum class Kind : std::uint8_t {
    note,    ///< of an event
    met,     ///< an expectation
    failed,  ///< an expectation, or a command that the module refused
    end,     ///< of the run: by an event or when its duration is over; once, after all else that happens at that time
  };

  Kind kind;
  Place place;        ///< in the scenario's file
  Microseconds time;  ///< since the begin of the run
  std::string text;
};

/// Acts at exact microseconds of simulated time. Conditions are looked at every 1 ms as long as anything waits for one,
/// and ramps move in steps of 1 ms, both counted from the begin of the run; so nothing depends on how fast it runs.
///
/// At one time, things happen in this order: pulses end and ramps move; events with `at`, as they stand in the file;
/// events with `when`, likewise; expectations. (docs/decisions/0043-scenarios.md)
class ScenarioRun final : public BenchActor {
 public:
  static constexpr Microseconds look_interval = one_millisecond;
  using Listener = std::function<void(const Report& report)>;

  /// The run begins at module.now(). All must outlive this; add it to the module as an actor.
  ScenarioRun(const Scenario& scenario, const VirtualModule& module, Listener listener = {});

  Microseconds next_act() const override;
  void act(VirtualModule& module) override;

  bool has_ended() const { return ended_; }
  /// No more time will pass: expectations that are still open fail, and nothing happens any more.
  void finish(const VirtualModule& module);
  std::size_t failures() const { return failures_; }

 private:
  struct TimedEvent {
    const Event* event;
    Microseconds next;  ///< absolute; `never` when it is over
  };
  struct WaitingEvent {
    const Event* event;
    bool is_over = false;
    bool has_happened = false;  ///< since the condition became true
    Microseconds true_since = never;
  };
  struct Ramp {
    Assignment end;
    double from;
    Microseconds begin;
    Microseconds duration;
  };
  struct PulseEnd {
    Assignment former;
    Microseconds time;
  };
  struct OpenExpectation {
    const Expectation* expectation;
    Microseconds due;
    bool is_open = true;
  };
  struct PendingCommand {
    const HostCommand* command;
    Place place;
  };

  bool looks_regularly() const;
  void move(twin::World& world, Microseconds now);
  double value_without_pulse(const twin::Quantity& quantity, const twin::World& world) const;
  void happen(const Event& event, VirtualModule& module, Microseconds now);
  void wait_for(WaitingEvent& waiting, VirtualModule& module, Microseconds now);
  void send_pending(VirtualModule& module);
  void check(OpenExpectation& open, VirtualModule& module, Microseconds now);
  void check_answer(const Expectation& expectation, VirtualModule& module, Microseconds now);
  void report(Report::Kind kind, Place place, Microseconds now, std::string text);

  Microseconds begin_;
  Listener listener_;
  std::vector<TimedEvent> timed_;
  std::vector<WaitingEvent> waiting_;
  std::vector<Ramp> ramps_;
  std::vector<PulseEnd> pulses_;
  std::vector<OpenExpectation> expectations_;
  std::deque<PendingCommand> commands_;
  Microseconds next_look_;
  std::size_t failures_ = 0;
  Microseconds end_;  ///< `never` without a duration
  Place end_place_;
  bool ended_ = false;
};

}  // namespace opentmcl::scenario
