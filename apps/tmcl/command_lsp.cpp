// tmcl lsp: the language server.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdint>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "editor/lsp/serve.hpp"
#include "editor/message_stream.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

constexpr const char* footer =
    R"(An editor starts it and speaks the Language Server Protocol with it over stdin and stdout; docs/editors.md has the
set-up for VS Code, Neovim, Emacs and Helix. In Neovim:

  vim.lsp.start_client({ cmd = { "tmcl", "lsp" }, init_options = { module = "tmcm1110" } })

Initialization options and settings: "module", pd1161 (the default) or tmcm1110, for sources that do not say it in a
comment such as // module: tmcm1110, and "includePath", a list of folders to look for included files.

Exit code: 0 when the editor has shut it down, 1 when the editor left without, 76 when what comes is not the protocol.)";

Result<int> run_lsp() {
  std::signal(SIGPIPE, SIG_IGN);  // an editor can go at any time; write(2) says so
  editor::DescriptorStream stream(STDIN_FILENO, STDOUT_FILENO);
  lang::DiskFiles disk;
  const editor::lsp::ServeResult served = editor::lsp::serve(stream, disk);
  if (!served.error.empty()) return Error{ErrorKind::protocol, served.error, {}};
  return served.exit_code;
}

}  // namespace

void add_lsp(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("lsp", "language server for editors, on stdin and stdout")->fallthrough();
  command->footer(footer);
  // Editors that know many servers add it to any of them; there is no other way.
  command
      ->add_flag_function(
          "--stdio", [](std::int64_t) {}, "ignored")
      ->group("");
  command->callback([&context] {
    const Result<int> served = run_lsp();
    if (!served) return context.finish(served.error());
    context.exit_code = *served;
  });
}

}  // namespace opentmcl::app
