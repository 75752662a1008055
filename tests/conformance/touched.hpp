// What the statements about a module send to it: the completeness of the table is judged by this.
#pragma once

#include <cstdint>
#include <set>
#include <tuple>

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/status_codes.hpp"
#include "firmware/wire/datagram.hpp"
#include "tests/conformance/conformance_table.hpp"

namespace opentmcl::conformance {

class Touched {
 public:
  /// Reads steps and programs of all statements about `module`.
  /// @throws std::runtime_error when a step or a program is malformed
  Touched(const ConformanceTable& table, const ModuleDescription& module);

  bool has_opcode(Opcode opcode) const { return opcodes_.count(static_cast<std::uint8_t>(opcode)) != 0; }
  bool has_status(Status status) const { return statuses_.count(static_cast<std::uint8_t>(status)) != 0; }
  /// With any value.
  bool has(Opcode opcode, int type, int motor) const;
  bool has(Opcode opcode, int type, int motor, std::int32_t value) const;

 private:
  using Sent = std::tuple<std::uint8_t, std::uint8_t, std::uint8_t, std::int32_t>;

  void note(const Command& command);

  std::set<std::uint8_t> opcodes_;
  std::set<std::uint8_t> statuses_;
  std::set<Sent> sent_;
};

}  // namespace opentmcl::conformance
