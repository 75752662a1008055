// The breakpoints of a client. Each request brings all breakpoints of a kind, those of lines all of a file; the engine
// knows single ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "debug/engine.hpp"
#include "editor/dap/program_sources.hpp"
#include "editor/dap/protocol.hpp"

namespace opentmcl::editor::dap {

/// What breakpoints are put into. One for each run of a program, because a restart reads the source anew.
struct BreakpointPlace {
  debug::Engine& engine;
  const ProgramSources& sources;
  const ClientConventions& client;
  bool only_runs = false;  ///< without debugging: nothing is to stop it
};

class BreakpointSets {
 public:
  enum class Kind : std::uint8_t { line, function, instruction, data };

  /// What a stop at a breakpoint of a kind is called.
  static const char* stop_reason_of(Kind kind);

  /// Puts the breakpoints of a request in the place of those of the last one of its kind, and file.
  /// @return the body of the response. Error: usage, for arguments that are none.
  Answer set(Kind kind, const json& arguments, const BreakpointPlace& place);

  /// Puts all of them into another engine, with the ids they have. @return bodies of breakpoint events
  std::vector<json> move_to(const BreakpointPlace& place);

  struct Hit {
    std::int64_t id = 0;
    Kind kind = Kind::line;
  };
  /// By the engine's number; nothing for one that no client has set.
  std::optional<Hit> find(int number) const;

 private:
  struct Placed {
    std::int64_t id;
    std::optional<int> number;  ///< none: it could not be placed
  };
  struct Group {
    Kind kind;
    std::string file;  ///< of lines: what the client calls it
    json wanted;       ///< array of the request
    json source;       ///< of the request
    std::vector<Placed> placed;
  };

  /// @return the protocol's Breakpoint
  json place_one(const Group& group, const json& wanted, Placed& placed, const BreakpointPlace& place);

  std::vector<Group> groups_;
  std::int64_t last_id_ = 0;
};

}  // namespace opentmcl::editor::dap
