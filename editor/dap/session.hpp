// What an adapter debugs: it does not know how modules are found, twins begun and sources read.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "client/error.hpp"
#include "client/program_transfer.hpp"
#include "debug/engine.hpp"
#include "debug/program.hpp"
#include "debug/target.hpp"
#include "editor/dap/protocol.hpp"

namespace opentmcl::editor::dap {

/// The attributes of a launch or an attach. Empty texts: not given.
struct SessionRequest {
  bool attaches = false;       ///< to a program that is in the module already
  std::string program;         ///< path of a source; needed unless it attaches
  std::string module;          ///< "pd1161"
  std::string default_module;  ///< an editor's setting: of a twin whose source does not say what it is for
  std::string port;            ///< "/dev/ttyACM0"; empty: a twin in this process
  std::string scenario;        ///< path; twins only
  bool stops_on_entry = true;
  bool without_debugging = false;  ///< only run it
  bool trusts = false;             ///< attaches without looking whether the program is that of the source

  /// Error: usage.
  static client::Result<SessionRequest> read(const json& arguments, bool attaches);
};

/// Takes what the user is to read: diagnostics of a source, what a scenario says.
using Say = std::function<void(Voice voice, const std::string& text)>;

/// A module, and the program that belongs into it. Real: in apps/tmcl. For tests: a twin and a text.
class Session {
 public:
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  virtual ~Session() = default;

  virtual debug::Target& target() = 0;
  /// Gives the program away: to be called once.
  virtual debug::Program take_program() = 0;
  /// Brings the engine's program into the module, or makes sure that it is there, as the request says.
  /// @return what was done, as a sentence. Errors: bad_file (another program is there), refused (code protection),
  /// and those of client::Client.
  virtual client::Result<std::string> load(debug::Engine& engine, const client::Progress& progress) = 0;
};

/// Errors: usage; bad_file, with diagnostics said before; no_such_device, and those of client::Client.
using OpenSession = std::function<client::Result<std::unique_ptr<Session>>(
    const SessionRequest& request, const Say& say, const client::Progress& progress)>;

}  // namespace opentmcl::editor::dap
