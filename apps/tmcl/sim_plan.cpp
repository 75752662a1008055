#include "apps/tmcl/sim_plan.hpp"

#include <string>
#include <utility>

#include "apps/tmcl/context.hpp"
#include "apps/tmcl/quantity.hpp"
#include "apps/tmcl/scenario_source.hpp"
#include "apps/tmcl/source_program.hpp"
#include "server/session_log_reader.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using server::SessionLogReader;
using server::SessionSetup;

namespace {

/// @param program the text of that of --program
Result<SessionSetup> setup_of(const SimOptions& options, const std::string& program) {
  SessionSetup setup;
  if (!options.past().empty()) {
    Result<SessionLogReader> log = SessionLogReader::open(options.past());
    if (!log) return log.error();
    return log->setup();
  }
  if (!options.scenario.empty()) {
    Result<ScenarioSource> source = scenario_from_file(options.scenario);
    if (!source) return source.error();
    setup.module = source->scenario.module;
    setup.scenario = std::move(source->text);
    setup.scenario_name = options.scenario;
    return setup;
  }
  const Result<const ModuleDescription*> found = module_of_source(options.program, program, options.module);
  if (!found) return found.error();
  setup.module = *found;
  setup.machine = options.machine;
  if (!options.motor.empty()) setup.motor = options.motor;
  return setup;
}

Result<std::vector<Command>> program_of(const SimOptions& options, std::string text,
                                        const scenario::Scenario& scenario) {
  // A log has the commands with which its program was loaded.
  if (!options.past().empty()) return std::vector<Command>();
  const lang::AssemblerOptions assembler = assembler_options(options.assembler, *scenario.module);
  const std::string path = program_path(scenario, options.scenario);
  if (path.empty() && options.program.empty()) return std::vector<Command>();
  const Result<lang::AssemblyResult> assembled = options.program.empty()
                                                     ? assemble_file(path, assembler)
                                                     : assemble_text(options.program, std::move(text), assembler);
  if (!assembled) return assembled.error();
  return assembled->program->commands;
}

Result<scenario::Recording> recording_of(const SimOptions& options, const scenario::Scenario& scenario) {
  scenario::Recording recording = scenario.recording;
  // What was recorded then shall not be overwritten.
  if (!options.past().empty()) recording.file.clear();
  if (!options.record.empty()) recording.file = options.record;
  if (recording.file.empty() && !(options.signals.empty() && options.record_every.empty())) {
    return Error{ErrorKind::usage, "nothing is recorded: --signals and --record-every go with --record FILE", {}};
  }
  if (!options.signals.empty()) recording.signals = options.signals;
  if (!options.record_every.empty()) {
    const Result<Microseconds> every = parse_duration(options.record_every);
    if (!every) return every.error();
    if (*every == 0) return Error{ErrorKind::usage, "--record-every: expected a duration greater than 0", {}};
    recording.every = *every;
  }
  return recording;
}

}  // namespace

Result<SimPlan> SimPlan::of(const SimOptions& options) {
  SimPlan plan;
  std::string text;
  if (!options.program.empty()) {
    Result<std::string> read = read_source(options.program);
    if (!read) return read.error();
    text = *std::move(read);
  }
  Result<SessionSetup> setup = setup_of(options, text);
  if (!setup) return setup.error();
  plan.setup = *std::move(setup);
  Result<scenario::Scenario> scenario = scenario_of(plan.setup);
  if (!scenario) return scenario.error();
  plan.scenario = *std::move(scenario);
  const Result<double> speed = parse_speed(options.speed);
  if (!speed) return speed.error();
  plan.speed = *speed;
  plan.duration = options.past().empty() ? plan.scenario.duration : 0;
  if (!options.duration.empty()) {
    const Result<Microseconds> duration = parse_duration(options.duration);
    if (!duration) return duration.error();
    plan.duration = *duration;
  }
  Result<std::vector<Command>> program = program_of(options, std::move(text), plan.scenario);
  if (!program) return program.error();
  plan.program = *std::move(program);
  Result<scenario::Recording> recording = recording_of(options, plan.scenario);
  if (!recording) return recording.error();
  plan.recording = *std::move(recording);
  return plan;
}

}  // namespace opentmcl::app
