#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "client/error.hpp"
#include "scenario/scenario_run.hpp"
#include "server/session_event.hpp"
#include "server/session_log.hpp"
#include "server/session_setup.hpp"
#include "server/signal_recording.hpp"
#include "twin/world/quantities.hpp"

namespace opentmcl::server {

class SessionLogReader;

/// A virtual module, its scenario, and everything that reaches it from outside. All of that can be logged, and a log
/// can be replayed: the module then does the same again, up to the last byte of its replies. A snapshot is a log, too:
/// to load one is to replay it (docs/decisions/0047-snapshots.md).
class Session {
 public:
  /// What the module's connectors lead to; outlives the session.
  struct Doors {
    std::vector<hal::BytePort*> ports;  ///< one for each of SessionSetup::ports; nullptr: nothing is plugged in
    hal::CanPort* can = nullptr;        ///< nothing is plugged in
  };

  /// Where a log goes, if there is one.
  using MakeLog = std::function<client::Result<SessionLog>(const SessionSetup&)>;

  /// Hears what the scenario of `setup` has to say.
  using Listener = std::function<void(const SessionSetup& setup, const scenario::Report& report)>;

  /// What is pointed to may be nullptr, else it outlives the session.
  struct Options {
    /// None: the session is not logged.
    MakeLog make_log = {};
    /// Hears every signal of the world, from the session's beginning.
    twin::TraceObserver* observer = nullptr;
    /// Of the scenario's time, from its begin to its end.
    SignalRecording* recording = nullptr;
    Listener listener = {};
  };

  /// A module that has just been switched on and taken its first turn. Errors: input_output (the log), bad_file (the
  /// scenario).
  static client::Result<std::unique_ptr<Session>> start(const SessionSetup& setup, Doors doors, Options options);

  /// Replays the log `path` to its end and goes on from there. A log that was cut off is replayed as far as it goes.
  /// Errors: input_output; bad_file (no log, or the module does not do what it did when the log was written).
  static client::Result<std::unique_ptr<Session>> resume(const std::string& path, Doors doors, Options options);

  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session();

  /// Another one after load().
  VirtualModule& module();
  const VirtualModule& module() const;
  const SessionSetup& setup() const;
  const scenario::Scenario& scenario() const;

  /// The scenario's time begins now. @param duration after which it ends; 0: never
  void begin(Microseconds duration);
  bool has_begun() const;
  /// Expectations of the scenario that were not met, and commands that the module refused.
  std::size_t failures() const;

  // ---- What a person at the bench can do; the module is told at once

  /// @pre twin::refusal() has no objection to any of the values
  void set(const std::vector<QuantitiesSet::Value>& values);
  void power_cycle();

  // ---- Recordings, as many as wanted at any time

  /// Begins now. @return its number. Errors: usage, input_output.
  client::Result<std::uint64_t> start_recording(scenario::Recording recording);
  /// Ends now. @return its path. Errors: usage (there is no such recording), input_output.
  client::Result<std::string> stop_recording(std::uint64_t number);

  // ---- The log

  /// Writes down what is to be seen now, if that was long ago, so that a replay can tell where it departs.
  void check_now_and_then();

  /// What is wrong with the log.
  std::optional<client::Error> log_failure() const;

  /// Writes a snapshot: a log of all up to now. Errors: usage (the session is not logged), input_output.
  client::Result<void> save(const std::string& path);

  /// Goes back, or forth, to a snapshot; the session stays as it is if that fails. What the scenario said before it is
  /// not said again. Errors: usage (of another module or other ports, or somebody records the world), and those of
  /// resume().
  client::Result<void> load(const std::string& path);

  /// The scenario, the log and all recordings are over; nobody hears of the world any more. Error: input_output (a
  /// recording).
  client::Result<void> finish();

 private:
  class Run;

  Session(Doors doors, Options options);
  client::Result<std::unique_ptr<Run>> made(const SessionSetup& setup);
  client::Result<std::unique_ptr<Run>> replayed(SessionLogReader& log, bool speaks);
  client::Result<void> adopt(std::unique_ptr<Run> run);

  Doors doors_;
  Options options_;
  /// One run after the other looks up the same.
  std::shared_ptr<twin::TorqueTables> tables_ = std::make_shared<twin::TorqueTables>();
  std::unique_ptr<Run> run_;
};

}  // namespace opentmcl::server
