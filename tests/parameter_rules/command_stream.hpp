// Random commands about parameters, what a module and the reference make of them, and the shortest stream on which
// they differ.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::tests {

/// One thing that happens to a module. Each has the same meaning wherever it stands in a stream, so that parts of a
/// stream can be left out.
struct Step {
  enum class Kind : std::uint8_t { command, power_cycle, software_reset, factory_reset };
  enum class Recipient : std::uint8_t { module, group, nobody };

  Kind kind = Kind::command;
  Recipient recipient = Recipient::module;
  Command command{};
};

using Stream = std::vector<Step>;

/// As one would type it: "SAP 4, 0, 2048".
std::string mnemonic(const Step& step);
std::string mnemonics(const Stream& stream);

/// Valid, boundary and random numbers and values, all from the one generator.
Stream random_stream(ModuleId module, std::size_t length, std::mt19937_64& random);

struct Difference {
  std::size_t step;  ///< the last one that was executed
  std::string text;
};

/// Executes the stream on a new module and on the reference. @return where they first differ
std::optional<Difference> find_difference(ModuleId module, const Stream& stream);

/// Leaves out what is not needed for a difference, of whatever kind.
Stream shortest_with_difference(ModuleId module, Stream stream);

}  // namespace opentmcl::tests
