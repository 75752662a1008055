#include "server/signal_recording.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

namespace opentmcl::server {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// What is worth seeing of most runs.
constexpr const char* usual_signals[] = {"position", "velocity",    "rotor.angle", "stage",
                                         "encoder",  "left_switch", "home_switch", "right_switch"};

Error cannot_write(const std::string& path) {
  return {ErrorKind::input_output, "cannot write " + path + ": " + std::generic_category().message(errno), {}};
}

}  // namespace

Result<std::unique_ptr<SignalRecording>> SignalRecording::create(scenario::Recording recording,
                                                                 const twin::World& world) {
  if (recording.signals.empty()) {
    for (const char* const name : usual_signals) {
      if (!scenario::objection_to_signal(name, world)) recording.signals.emplace_back(name);
    }
  }
  for (const std::string& name : recording.signals) {
    if (const auto objection = scenario::objection_to_signal(name, world)) {
      return Error{ErrorKind::usage, *objection + " (tmcl scenario signals names all)", {}};
    }
  }
  std::unique_ptr<scenario::RecordingFormat> format = scenario::recording_format_of(recording.file);
  if (!format) {
    return Error{ErrorKind::usage, "\"" + recording.file + "\": expected a name that ends in .vcd or .csv", {}};
  }
  errno = 0;
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(recording.file.c_str(), "wb"));
  if (!file) return cannot_write(recording.file);
  return std::unique_ptr<SignalRecording>(
      new SignalRecording(std::move(recording), std::move(file), std::move(format)));
}

SignalRecording::SignalRecording(scenario::Recording recording, std::unique_ptr<std::FILE, CloseFile> file,
                                 std::unique_ptr<scenario::RecordingFormat> format)
    : recording_(std::move(recording)), file_(std::move(file)) {
  recorder_.emplace(recording_, std::move(format), [this](std::string_view text) {
    // What the disk refuses is noticed in close(): the stream remembers.
    std::fwrite(text.data(), 1, text.size(), file_.get());
  });
}

void SignalRecording::start(VirtualModule& module) {
  recorder_->start(module);
  module.add_actor(*recorder_);
  module_ = &module;
  is_running_ = true;
}

void SignalRecording::stop() {
  if (std::exchange(is_running_, false)) recorder_->finish(*module_);
}

Result<void> SignalRecording::close() {
  stop();
  if (module_ != nullptr) std::exchange(module_, nullptr)->remove_actor(*recorder_);
  errno = 0;
  if (std::fflush(file_.get()) != 0 || std::ferror(file_.get()) != 0) return cannot_write(path());
  return {};
}

}  // namespace opentmcl::server
