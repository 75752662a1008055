#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "boards/twin/virtual_module.hpp"
#include "client/error.hpp"
#include "scenario/recorder.hpp"

namespace opentmcl::server {

/// A recording of signals and the file that it goes to.
class SignalRecording {
 public:
  /// Opens the file. Without names in `recording` it has the signals that are worth seeing of most runs.
  /// @param world one with the machine that will be recorded
  /// Errors: usage (no such signal there, or a name that ends in neither .vcd nor .csv), input_output.
  static client::Result<std::unique_ptr<SignalRecording>> create(scenario::Recording recording,
                                                                 const twin::World& world);

  SignalRecording(const SignalRecording&) = delete;
  SignalRecording& operator=(const SignalRecording&) = delete;

  const std::string& path() const { return recording_.file; }

  /// Hears every signal of the world that is recorded.
  twin::TraceObserver& observer() { return *recorder_; }
  /// Begins now. @pre called once; close() comes before the module's end
  void start(VirtualModule& module);
  /// Nothing is recorded from now on.
  void stop();
  /// Stops and writes the rest; @pre no actor of the module acts. Error: input_output, now or at any time before.
  client::Result<void> close();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  SignalRecording(scenario::Recording recording, std::unique_ptr<std::FILE, CloseFile> file,
                  std::unique_ptr<scenario::RecordingFormat> format);

  scenario::Recording recording_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::optional<scenario::Recorder> recorder_;
  VirtualModule* module_ = nullptr;  ///< from start() to close()
  bool is_running_ = false;
};

}  // namespace opentmcl::server
