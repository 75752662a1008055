// For tests: an engine with a twin, and all that is to be seen of it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "debug/debugging_test.hpp"
#include "debug/twin/twin_target.hpp"
#include "scenario/scenario_file.hpp"

namespace opentmcl::debug {

struct Bench {
  explicit Bench(std::string_view source, TwinSetup setup = {})
      : twin(std::move(setup)),
        engine(twin, program_of(source), [this](const std::string& text) { output.push_back(text); }) {
    launch(engine);
  }

  TwinTarget twin;
  std::vector<std::string> output;
  Engine engine;
};

/// All that is to be seen of a program that stands.
struct Seen {
  std::uint16_t address;
  std::int32_t accumulator;
  std::int32_t x;
  std::vector<std::int32_t> variables;
  std::vector<std::uint16_t> frames;
  std::uint8_t flags;
  Comparison comparison;
  Moment moment;

  friend bool operator==(const Seen&, const Seen&) = default;
};

inline Seen see(Engine& engine) {
  const RegisterValues registers = value_of(engine.registers());
  Seen seen{
      registers.program_counter,   registers.accumulator,        registers.x, {}, {}, registers.inner->error_flags,
      registers.inner->comparison, engine.target().twin()->now()};
  for (std::uint8_t number = 0; number < 6; ++number) seen.variables.push_back(value_of(engine.variable(number)));
  for (const Frame& frame : engine.frames()) seen.frames.push_back(frame.address);
  return seen;
}

/// On the default stage, 5 mm before its hard end.
inline TwinSetup near_the_end() {
  scenario::ScenarioFile file =
      scenario::read_scenario("module = \"pd1161\"\nduration = \"10 s\"\n[machine]\nstart = \"-45 mm\"\n");
  TwinSetup setup;
  setup.scenario = file.scenario.value();
  return setup;
}

/// 150 rpm to the left; a stall stops the motor.
inline constexpr std::string_view into_the_end = R"(
#include TMCLParam.tmc
        SAP APPulseDivisor, 0, 0
        SAP APMaxCurrent, 0, 128
        SAP APStallGuardFilter, 0, 0
        SAP APStallGuardThreshold, 0, -18
        ROL 0, 524
        WAIT TICKS, 0, 20
        SAP APStopOnStall, 0, 500
Loop:   JA Loop
)";

}  // namespace opentmcl::debug
