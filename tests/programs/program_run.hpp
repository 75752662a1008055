// Runs a test program on a virtual module and compares what happens with its script.
#pragma once

#include <string>
#include <vector>

#include "firmware/wire/datagram.hpp"
#include "tests/module/bench.hpp"
#include "tests/programs/program_script.hpp"

namespace opentmcl::tests {

struct TestProgram {
  std::string path;
  ProgramScript script;
  std::vector<Command> commands;
};

/// One run of a program. Expectations that fail are failures of the test, at their line of the program.
class ProgramRun {
 public:
  ProgramRun(const TestProgram& program, const ModuleDescription& module);

  void execute();

 private:
  void download();
  void apply(const Setting& setting);
  std::int32_t read(const Quantity& quantity);
  bool holds(const Expectation& expectation);
  void check(const Expectation& expectation);
  bool is_running();
  /// A command of the host that takes no time.
  Reply command(Opcode opcode, std::uint8_t type = 0, std::uint8_t motor = 0, std::int32_t value = 0);
  void fail(int line, const std::string& message) const;

  const TestProgram& program_;
  Bench bench_;
};

}  // namespace opentmcl::tests
