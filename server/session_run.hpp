#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "boards/twin/paced_port.hpp"
#include "boards/twin/virtual_module.hpp"
#include "scenario/scenario_run.hpp"
#include "server/session.hpp"
#include "server/session_log_reader.hpp"
#include "twin/world/digest.hpp"

namespace opentmcl::server {

/// One life of a session's module: its doors are first fed from a log that is replayed, if any, and then lead outside.
class Session::Run final : private ExtraTurnObserver {
 public:
  /// @param options outlive this
  Run(SessionSetup setup, scenario::Scenario scenario, std::optional<SessionLog> log, const Options& options,
      std::shared_ptr<twin::TorqueTables> tables);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run();

  VirtualModule& module() { return *module_; }
  const SessionSetup& setup() const { return setup_; }
  const scenario::Scenario& scenario() const { return scenario_; }
  /// nullptr before it begins.
  const scenario::ScenarioRun* scenario_run() const { return scenario_run_ ? &*scenario_run_ : nullptr; }
  std::optional<SessionLog>& log() { return log_; }

  /// Lets all of `source` happen. Error: bad_file.
  client::Result<void> replay(SessionLogReader& source);
  /// From now on what comes from outside comes from there.
  void connect(const Doors& doors);

  /// Whether the listener hears of the scenario.
  void set_speaking(bool speaks) { speaks_ = speaks; }

  void begin(Microseconds duration);
  client::Result<void> finish();

  std::uint64_t start_recording(std::unique_ptr<SignalRecording> recording);
  client::Result<std::string> stop_recording(std::uint64_t number);
  bool is_recorded() const { return !recordings_.empty(); }

  void set(const std::vector<QuantitiesSet::Value>& values);
  void power_cycle();
  Check check() const;
  void check_now_and_then();

 private:
  class Port;
  class CanLine;

  /// Hands the trace on to all who want it.
  class Listeners final : public twin::TraceObserver {
   public:
    void add(twin::TraceObserver& listener) { listeners_.push_back(&listener); }
    void remove(const twin::TraceObserver& listener) { std::erase(listeners_, &listener); }
    bool empty() const { return listeners_.empty(); }
    void changed(twin::Tick tick, std::string_view signal, std::int64_t value) override {
      for (twin::TraceObserver* listener : listeners_) listener->changed(tick, signal, value);
    }

   private:
    std::vector<twin::TraceObserver*> listeners_;
  };

  void extra_turn(Microseconds now) override;
  void note(const SessionEvent& event);
  void start(SignalRecording& recording);
  client::Result<void> close(SignalRecording& recording);
  void report(const scenario::Report& what);
  /// What the log that is replayed has for the firmware at this very moment.
  template <class What>
  const What* replayed() const;
  void take_replayed();
  std::optional<client::Error> repeat(const SessionEvent& event);
  std::optional<client::Error> expect(const Check& recorded);

  SessionSetup setup_;
  scenario::Scenario scenario_;
  std::optional<SessionLog> log_;
  const Options& options_;
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<std::unique_ptr<PacedPort>> wires_;
  std::unique_ptr<CanLine> can_;
  Listeners listeners_;
  std::unique_ptr<VirtualModule> module_;
  std::optional<scenario::ScenarioRun> scenario_run_;
  std::map<std::uint64_t, std::unique_ptr<SignalRecording>> recordings_;
  std::uint64_t last_recording_ = 0;
  bool speaks_ = true;
  bool is_finished_ = false;
  SessionLogReader* source_ = nullptr;  // while it is replayed
  twin::Digest replies_;
  Microseconds last_check_ = 0;
};

}  // namespace opentmcl::server
