#include "server/session.hpp"

#include <utility>

#include "server/session_log_reader.hpp"
#include "server/session_run.hpp"

namespace opentmcl::server {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

Result<std::optional<SessionLog>> log_of(const Session::Options& options, const SessionSetup& setup) {
  std::optional<SessionLog> log;
  if (!options.make_log) return log;
  Result<SessionLog> made = options.make_log(setup);
  if (!made) return made.error();
  log.emplace(std::move(*made));
  return log;
}

}  // namespace

Session::Session(Doors doors, Options options) : doors_(std::move(doors)), options_(std::move(options)) {}

Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::start(const SessionSetup& setup, Doors doors, Options options) {
  std::unique_ptr<Session> session(new Session(std::move(doors), std::move(options)));
  Result<std::unique_ptr<Run>> run = session->made(setup);
  if (!run) return run.error();
  if (Result<void> adopted = session->adopt(std::move(*run)); !adopted) return adopted.error();
  return session;
}

Result<std::unique_ptr<Session>> Session::resume(const std::string& path, Doors doors, Options options) {
  Result<SessionLogReader> log = SessionLogReader::open(path);
  if (!log) return log.error();
  std::unique_ptr<Session> session(new Session(std::move(doors), std::move(options)));
  constexpr bool speaks = true;
  Result<std::unique_ptr<Run>> run = session->replayed(*log, speaks);
  if (!run) return run.error();
  if (Result<void> adopted = session->adopt(std::move(*run)); !adopted) return adopted.error();
  return session;
}

Result<std::unique_ptr<Session::Run>> Session::made(const SessionSetup& setup) {
  Result<scenario::Scenario> scenario = scenario_of(setup);
  if (!scenario) return scenario.error();
  Result<std::optional<SessionLog>> log = log_of(options_, setup);
  if (!log) return log.error();
  return std::make_unique<Run>(setup, *std::move(scenario), std::move(*log), options_, tables_);
}

Result<std::unique_ptr<Session::Run>> Session::replayed(SessionLogReader& log, bool speaks) {
  Result<std::unique_ptr<Run>> run = made(log.setup());
  if (!run) return run.error();
  (*run)->set_speaking(speaks);
  if (Result<void> done = (*run)->replay(log); !done) return done.error();
  (*run)->set_speaking(true);
  return run;
}

Result<void> Session::adopt(std::unique_ptr<Run> run) {
  if (run->log()) {
    if (Result<void> published = run->log()->publish(); !published) return published;
  }
  run_ = std::move(run);
  run_->connect(doors_);
  return {};
}

VirtualModule& Session::module() {
  return run_->module();
}

const VirtualModule& Session::module() const {
  return run_->module();
}

const SessionSetup& Session::setup() const {
  return run_->setup();
}

const scenario::Scenario& Session::scenario() const {
  return run_->scenario();
}

void Session::begin(Microseconds duration) {
  run_->begin(duration);
}

bool Session::has_begun() const {
  return run_->scenario_run() != nullptr;
}

std::size_t Session::failures() const {
  return has_begun() ? run_->scenario_run()->failures() : 0;
}

void Session::set(const std::vector<QuantitiesSet::Value>& values) {
  run_->set(values);
}

void Session::power_cycle() {
  run_->power_cycle();
}

Result<std::uint64_t> Session::start_recording(scenario::Recording recording) {
  Result<std::unique_ptr<SignalRecording>> made = SignalRecording::create(std::move(recording), module().world());
  if (!made) return made.error();
  return run_->start_recording(std::move(*made));
}

Result<std::string> Session::stop_recording(std::uint64_t number) {
  return run_->stop_recording(number);
}

void Session::check_now_and_then() {
  run_->check_now_and_then();
}

std::optional<Error> Session::log_failure() const {
  return run_->log() ? run_->log()->failure() : std::nullopt;
}

Result<void> Session::save(const std::string& path) {
  std::optional<SessionLog>& log = run_->log();
  if (!log) return Error{ErrorKind::usage, "the session is not logged, so it cannot be saved", {}};
  return log->save(path, {module().now(), SessionEnd{run_->check()}});
}

Result<void> Session::load(const std::string& path) {
  if (options_.observer != nullptr || options_.recording != nullptr || run_->is_recorded()) {
    return Error{ErrorKind::usage, "a trace or a recording is being written; it would have to go back in time", {}};
  }
  Result<SessionLogReader> log = SessionLogReader::open(path);
  if (!log) return log.error();
  const SessionSetup& there = log->setup();
  if (!there.has_same_doors(setup())) {
    return Error{ErrorKind::usage,
                 path + " is of a " + there.module->name +
                     " with other ports; start the simulation with it, or with the same options",
                 {}};
  }
  constexpr bool speaks = false;
  Result<std::unique_ptr<Run>> run = replayed(*log, speaks);
  if (!run) return run.error();
  return adopt(std::move(*run));
}

Result<void> Session::finish() {
  return run_->finish();
}

}  // namespace opentmcl::server
