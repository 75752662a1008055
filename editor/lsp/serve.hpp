#pragma once

#include <string>

#include "editor/message_stream.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::editor::lsp {

struct ServeResult {
  int exit_code = 0;  ///< as the protocol has it: 0 after shutdown and exit, 1 after exit alone
  std::string error;  ///< what broke the conversation; empty if the client ended it
};

/// Serves one client until it says `exit` or goes.
///
/// Messages that have arrived already are looked at before the next one is answered: what has been cancelled need not
/// be done, and diagnostics are published once for many changes, when no message waits.
ServeResult serve(MessageStream& stream, lang::FileProvider& disk);

}  // namespace opentmcl::editor::lsp
