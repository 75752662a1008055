#pragma once

#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boards/twin/virtual_module.hpp"
#include "client/error.hpp"
#include "scenario/recorder.hpp"
#include "scenario/scenario.hpp"
#include "scenario/scenario_run.hpp"

namespace opentmcl::app {

/// Reads a scenario and prints what is wrong with it on stderr. The paths in it become ones from the working directory.
/// Error: bad_file.
client::Result<scenario::Scenario> scenario_from_file(const std::string& path);

/// What happens at the bench of `tmcl sim`: a scenario, a recording, both or neither.
class BenchSession {
 public:
  struct Options {
    std::string scenario;              ///< path; empty: none
    std::string record;                ///< path; empty: what the scenario says
    std::vector<std::string> signals;  ///< empty: what the scenario says, or usual ones
    std::string record_every;          ///< empty: what the scenario says, or 1 ms
    bool json = false;                 ///< reports as JSON
  };

  /// Errors: bad_file, usage.
  static client::Result<std::unique_ptr<BenchSession>> open(const Options& options);

  /// Without a scenario one in which nothing happens.
  scenario::Scenario& scenario() { return scenario_; }
  bool has_scenario() const { return !options_.scenario.empty(); }

  /// Opens the recording; once the machine is known. Errors: usage, input_output.
  client::Result<void> prepare_recording();
  /// Of the module's world; nullptr without a recording.
  twin::TraceObserver* observer() { return recorder_ ? &*recorder_ : nullptr; }
  /// Before the module gets its supply.
  void prepare(VirtualModule& module) { scenario_.write_initial(module.world()); }
  /// The run begins now. @param ended called when it has come to its end
  void start(VirtualModule& module, std::function<void()> ended);
  /// The run is over. Errors: refused for failed expectations, input_output.
  client::Result<void> finish(VirtualModule& module);

 private:
  explicit BenchSession(Options options) : options_(std::move(options)) {}

  void report(const scenario::Report& what) const;

  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  Options options_;
  scenario::Scenario scenario_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::optional<scenario::Recorder> recorder_;
  std::optional<scenario::ScenarioRun> run_;
  bool recording_ended_ = false;
};

}  // namespace opentmcl::app
