// A scenario: a module and its machine, and what happens to them. docs/scenarios.md describes the files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/hal/time.hpp"
#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "scenario/bench_setup.hpp"
#include "scenario/condition.hpp"

namespace opentmcl::scenario {

/// Of a file, from 1.
struct Place {
  unsigned line = 0;
  unsigned column = 0;
};

/// A TMCL command as a host would send it.
struct HostCommand {
  std::string text;  ///< "ROR 0, 500"
  Command command;
};

/// Something that happens at a time or under a condition. All times count from the begin of the run.
struct Event {
  Place place;

  std::optional<Microseconds> at;
  Microseconds every = 0;  ///< again after this much time, for ever; 0: once

  std::optional<Condition> when;
  Microseconds held_for = 0;  ///< the condition must have held for this long
  bool repeat = false;        ///< again whenever it has become true anew

  std::vector<Assignment> set;
  std::vector<Assignment> pulse;  ///< back to the former values after `lasting`
  Microseconds lasting = 0;
  std::vector<Assignment> ramp;  ///< evenly to these values in the time `over`
  Microseconds over = 0;
  std::vector<HostCommand> send;
  bool power_cycle = false;
  bool end = false;
  std::string note;
};

/// What must be so, at a time or once until a time.
struct Expectation {
  Place place;
  std::optional<Microseconds> at;
  std::optional<Microseconds> by;
  std::optional<Condition> that;
  std::optional<HostCommand> answer_to;
  std::int32_t is = 0;  ///< value of that answer
};

struct Recording {
  std::string file;  ///< empty: none
  std::vector<std::string> signals;
  Microseconds every = one_millisecond;
  bool exact = true;
  std::optional<Condition> when;
  Microseconds before = 0;
};

/// A bench and what happens at it.
struct Scenario : BenchSetup {
  const ModuleDescription* module = &pd1161;
  std::string description;
  std::string program;        ///< path; empty: none
  Place program_place;        ///< of that path in the file
  Microseconds duration = 0;  ///< 0: no end
  Recording recording;
  std::vector<Event> events;
  std::vector<Expectation> expectations;
};

}  // namespace opentmcl::scenario
