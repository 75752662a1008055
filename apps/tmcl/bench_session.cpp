#include "apps/tmcl/bench_session.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "apps/tmcl/quantity.hpp"
#include "apps/tmcl/source_program.hpp"
#include "scenario/scenario_file.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using scenario::Report;

namespace {

/// What is worth seeing of most runs.
constexpr const char* usual_signals[] = {"position", "velocity",    "rotor.angle", "stage",
                                         "encoder",  "left_switch", "home_switch", "right_switch"};

constexpr double microseconds_a_second = 1e6;

const char* name_of(Report::Kind kind) {
  switch (kind) {
    case Report::Kind::note:
      return "note";
    case Report::Kind::met:
      return "as expected";
    case Report::Kind::failed:
      return "FAILED";
    case Report::Kind::end:
      return "end";
  }
  return "";
}

Error cannot_write(const std::string& path) {
  return {
      ErrorKind::input_output, fmt::format("cannot write {}: {}", path, std::generic_category().message(errno)), {}};
}

}  // namespace

Result<scenario::Scenario> scenario_from_file(const std::string& path) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  scenario::ScenarioFile file = scenario::read_scenario(*text);
  if (!file.scenario) {
    fmt::print(stderr, "{}", scenario::format(file.problems, path));
    const std::size_t count = file.problems.size();
    return Error{ErrorKind::bad_file, fmt::format("{} has {} error{}", path, count, count == 1 ? "" : "s"), {}};
  }
  std::string& program = file.scenario->program;
  if (!program.empty()) {
    program = (std::filesystem::path(path).parent_path() / program).string();
    std::error_code cannot_tell;
    if (!std::filesystem::is_regular_file(program, cannot_tell)) {
      const scenario::Problem problem{file.scenario->program_place, fmt::format("there is no file '{}'", program)};
      fmt::print(stderr, "{}", scenario::format({problem}, path));
      return Error{ErrorKind::bad_file, fmt::format("{} has 1 error", path), {}};
    }
  }
  return *std::move(file.scenario);
}

Result<std::unique_ptr<BenchSession>> BenchSession::open(const Options& options) {
  std::unique_ptr<BenchSession> session(new BenchSession(options));
  if (!options.scenario.empty()) {
    Result<scenario::Scenario> read = scenario_from_file(options.scenario);
    if (!read) return read.error();
    session->scenario_ = *std::move(read);
  }
  scenario::Recording& recording = session->scenario_.recording;
  if (!options.record.empty()) recording.file = options.record;
  if (!options.signals.empty()) recording.signals = options.signals;
  if (!options.record_every.empty()) {
    const Result<Microseconds> every = parse_duration(options.record_every);
    if (!every) return every.error();
    if (*every == 0) return Error{ErrorKind::usage, "--record-every: expected a duration greater than 0", {}};
    recording.every = *every;
  }
  return session;
}

Result<void> BenchSession::prepare_recording() {
  scenario::Recording& recording = scenario_.recording;
  if (recording.file.empty()) {
    if (options_.signals.empty() && options_.record_every.empty()) return {};
    return Error{ErrorKind::usage, "nothing is recorded: --signals and --record-every go with --record FILE", {}};
  }
  const twin::World world(nullptr, scenario_.mounted(*scenario_.module));
  if (recording.signals.empty()) {
    for (const char* const name : usual_signals) {
      if (!scenario::objection_to_signal(name, world)) recording.signals.emplace_back(name);
    }
  }
  for (const std::string& name : recording.signals) {
    if (const auto objection = scenario::objection_to_signal(name, world)) {
      return Error{ErrorKind::usage, fmt::format("{} (tmcl scenario signals names all)", *objection), {}};
    }
  }
  std::unique_ptr<scenario::RecordingFormat> format = scenario::recording_format_of(recording.file);
  if (!format) {
    return Error{
        ErrorKind::usage, fmt::format("\"{}\": expected a name that ends in .vcd or .csv", recording.file), {}};
  }
  errno = 0;
  file_.reset(std::fopen(recording.file.c_str(), "wb"));
  if (!file_) return cannot_write(recording.file);
  recorder_.emplace(recording, std::move(format), [this](std::string_view text) {
    // What the disk refuses is noticed in finish(): the stream remembers.
    std::fwrite(text.data(), 1, text.size(), file_.get());
  });
  return {};
}

void BenchSession::start(VirtualModule& module, std::function<void()> ended) {
  run_.emplace(scenario_, module, [this, &module, ended = std::move(ended)](const Report& what) {
    if (has_scenario()) report(what);
    if (what.kind != Report::Kind::end) return;
    // Exactly here: the simulation stops a little later, nobody knows when.
    if (recorder_) recorder_->finish(module);
    recording_ended_ = true;
    ended();
  });
  module.add_actor(*run_);
  if (!recorder_) return;
  recorder_->start(module);
  module.add_actor(*recorder_);
}

Result<void> BenchSession::finish(VirtualModule& module) {
  run_->finish(module);
  if (recorder_) {
    if (!recording_ended_) recorder_->finish(module);
    errno = 0;
    if (std::fflush(file_.get()) != 0 || std::ferror(file_.get()) != 0) return cannot_write(scenario_.recording.file);
  }
  if (run_->failures() == 0) return {};
  const std::size_t count = run_->failures();
  return Error{ErrorKind::refused,
               fmt::format("{}: {} expectation{} failed", options_.scenario, count, count == 1 ? "" : "s"),
               {}};
}

void BenchSession::report(const Report& what) const {
  const double seconds = static_cast<double>(what.time) / microseconds_a_second;
  if (options_.json) {
    fmt::print("{}\n",
               nlohmann::ordered_json{
                   {"time", seconds}, {"kind", name_of(what.kind)}, {"line", what.place.line}, {"text", what.text}}
                   .dump());
  } else {
    // The end by the duration has no place in the file.
    const std::string line = what.place.line == 0 ? "" : fmt::format("{}:", what.place.line);
    fmt::print("{}:{} {:.6f} s: {}: {}\n", options_.scenario, line, seconds, name_of(what.kind), what.text);
  }
  std::fflush(stdout);
}

}  // namespace opentmcl::app
