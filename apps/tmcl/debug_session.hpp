// What `tmcl debug` and the debug adapter begin with: a module or a twin, and the program that is debugged.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/tmcl/assembler_choice.hpp"
#include "apps/tmcl/context.hpp"
#include "client/error.hpp"
#include "client/program_transfer.hpp"
#include "debug/engine.hpp"
#include "debug/program.hpp"
#include "debug/target.hpp"
#include "scenario/scenario_run.hpp"

namespace opentmcl::app {

/// What is wanted, as typed.
struct DebugRequest {
  std::string file;      ///< TMCL source; empty: the scenario's program, or what is in the module
  std::string module;    ///< empty: what the port says, or the source's comment
  std::string scenario;  ///< of the bench around a twin; empty: the usual bench
  AssemblerChoice assembler;
};

/// Who hears what has no place in an error. Nothing is printed.
struct DebugListeners {
  /// Diagnostics of source and scenario: whole lines.
  std::function<void(const std::string&)> diagnostics;
  /// What the scenario says while it runs.
  std::function<void(const scenario::Report&)> reports;
};

struct DebugSession {
  Connection connection;  ///< none for a twin
  std::unique_ptr<debug::Target> target;
  std::optional<debug::Program> program;
  std::string scenario;  ///< path; empty: none
};

/// Opens the port that `context` names, for ports sim:NAME a twin in this process, and assembles the program. Without a
/// source the program is read out of the module, with progress, and is its disassembly.
/// Errors: usage, bad_file, and those of the connection.
client::Result<DebugSession> open_debug_session(const Context& context, const DebugRequest& request,
                                                const DebugListeners& listeners, const client::Progress& progress);

/// How the program of an engine gets into its module.
enum class Loading : std::uint8_t {
  download,  ///< sends what differs, then stands before the first instruction
  attach,    ///< it must be there already; takes it as it is, running or not
  trust,     ///< as attach, and nothing is compared
};

/// What a user can do when the program in the module is another one, or hidden: in the words of where it was begun.
struct LoadingAdvice {
  std::string_view to_load;   ///< clause: how the source gets into the module
  std::string_view to_trust;  ///< subject of "takes that on trust": how the program is attached to without a comparison
};

/// @return what was done, as a sentence: "sent 3 of 40 instructions"
/// Errors: bad_file (attach: the program is another one, with its first difference), refused (code protection, with
/// what to do), protocol (what was sent did not arrive), and those of the connection.
client::Result<std::string> load_program(debug::Engine& engine, Loading loading, const LoadingAdvice& advice,
                                         const client::Progress& progress);

}  // namespace opentmcl::app
