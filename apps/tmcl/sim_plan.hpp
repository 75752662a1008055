#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/tmcl/assembler_choice.hpp"
#include "apps/tmcl/sim_endpoints.hpp"
#include "client/error.hpp"
#include "firmware/wire/datagram.hpp"
#include "scenario/scenario.hpp"
#include "server/session_setup.hpp"

namespace opentmcl::app {

/// The options of `tmcl sim`, as they were given.
struct SimOptions {
  std::string module;  ///< empty: what the program says, else the PD-1161
  SimEndpoints::Options endpoints;
  std::uint32_t wire = 0;  ///< bit/s of the serial line and of TCP; 0: bytes take no time
  std::string speed = "1";
  std::string duration;
  std::string eeprom;
  std::string program;
  AssemblerChoice assembler;
  std::string machine = "stage";
  std::string motor;  ///< empty: the module's own
  std::string scenario;
  std::string record;
  std::vector<std::string> signals;
  std::string record_every;
  std::string control;
  std::string log;
  std::string load;
  std::string replay;
  std::string trace;
  bool no_start = false;
  bool quiet = false;

  /// The log that is done again, to its end or to go on from there; empty: none.
  const std::string& past() const { return replay.empty() ? load : replay; }
};

/// What they mean.
struct SimPlan {
  server::SessionSetup setup;   ///< without its ports, and with a blank EEPROM unless it is from a log
  scenario::Scenario scenario;  ///< scenario_of(setup)
  double speed = 1;
  Microseconds duration = 0;     ///< of a new session; 0: no end
  std::vector<Command> program;  ///< to be loaded before the scenario's time begins
  scenario::Recording recording;

  /// Errors: usage, bad_file, input_output.
  static client::Result<SimPlan> of(const SimOptions& options);
};

}  // namespace opentmcl::app
