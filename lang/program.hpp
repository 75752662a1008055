#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/wire/datagram.hpp"
#include "lang/source.hpp"

namespace opentmcl::lang {

struct Label {
  std::string name;           ///< as written where it is defined
  std::uint32_t address = 0;  ///< instructions before it
  Span span;                  ///< of the name
};

/// An assembled program. A program address is an index into `commands`.
struct Program {
  std::vector<Command> commands;
  std::vector<Label> labels;     ///< in the order of their addresses
  std::vector<Span> source_map;  ///< of each command its text; empty, at the end, for an appended STOP
};

}  // namespace opentmcl::lang
