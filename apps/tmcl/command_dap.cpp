// tmcl dap: the debug adapter.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <utility>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/debug_session.hpp"
#include "apps/tmcl/interruption.hpp"
#include "apps/tmcl/source_program.hpp"
#include "editor/dap/adapter.hpp"
#include "editor/message_stream.hpp"
#include "lang/module_comment.hpp"
#include "scenario/scenario_run.hpp"

namespace opentmcl::app {

using client::Result;
using editor::dap::Say;
using editor::dap::Session;
using editor::dap::SessionRequest;
using editor::dap::Voice;

namespace {

constexpr const char* footer =
    R"(An editor starts it and speaks the Debug Adapter Protocol with it over stdin and stdout; docs/debug_adapter.md has
what it can do, and the set-up for Visual Studio Code, Neovim, Emacs and Helix. In Neovim, with nvim-dap:

  dap.adapters.tmcl = { type = "executable", command = "tmcl", args = { "dap" } }
  dap.configurations.tmcl = {{ type = "tmcl", request = "launch", name = "TMCL", program = "${file}" }}

A launch has the attributes program, module, port, scenario, stopOnEntry; an attach program, module, port, stopOnEntry,
trust. Without a port the program is debugged in a virtual module inside this process, or at the --port given here.

Exit codes: 0 when the editor has disconnected or gone, 76 when what comes is not the protocol.)";

constexpr double microseconds_a_second = 1e6;

/// "bench.toml:12: 0.500000 s: the left switch opens"
std::string text_of(const scenario::Report& report, const std::string& path) {
  const std::string line = report.place.line == 0 ? "" : fmt::format("{}:", report.place.line);
  return fmt::format("{}:{} {:.6f} s: {}", path, line, static_cast<double>(report.time) / microseconds_a_second,
                     report.text);
}

Loading loading_of(const SessionRequest& request) {
  if (!request.attaches) return Loading::download;
  return request.trusts ? Loading::trust : Loading::attach;
}

/// What an editor's setting says counts where nothing else says something (docs/decisions/0074-module-of-a-source.md).
Result<std::string> module_of(const SessionRequest& request) {
  const bool is_left_open = request.module.empty() && request.port.empty() && request.scenario.empty();
  if (!is_left_open || request.default_module.empty()) return request.module;
  const Result<std::string> text = read_file(request.program);
  if (!text) return text.error();
  return lang::module_named_in(*text) ? std::string() : request.default_module;
}

/// In the words of a launch configuration.
constexpr LoadingAdvice advice{R"("request": "launch" loads the source)", R"("request": "attach" with "trust": true)"};

class OpenedSession final : public Session {
 public:
  OpenedSession(DebugSession session, Loading loading) : session_(std::move(session)), loading_(loading) {}

  debug::Target& target() override { return *session_.target; }
  debug::Program take_program() override { return std::move(*session_.program); }
  Result<std::string> load(debug::Engine& engine, const client::Progress& progress) override {
    return load_program(engine, loading_, advice, progress);
  }

 private:
  DebugSession session_;
  Loading loading_;
};

Result<std::unique_ptr<Session>> open_session(Context context, const SessionRequest& request, const Say& say,
                                              const client::Progress& progress) {
  if (!request.port.empty()) context.port = request.port;
  DebugRequest wanted;
  wanted.file = request.program;
  const Result<std::string> module = module_of(request);
  if (!module) return module.error();
  wanted.module = *module;
  wanted.scenario = request.scenario;
  DebugListeners listeners;
  listeners.diagnostics = [say](const std::string& text) { say(Voice::problem, text); };
  listeners.reports = [say, path = request.scenario](const scenario::Report& report) {
    const bool is_wrong = report.kind == scenario::Report::Kind::failed;
    say(is_wrong ? Voice::problem : Voice::program, text_of(report, path));
  };
  Result<DebugSession> session = open_debug_session(context, wanted, listeners, progress);
  if (!session) return session.error();
  std::unique_ptr<Session> opened = std::make_unique<OpenedSession>(std::move(*session), loading_of(request));
  return opened;
}

Result<void> run_dap(const Context& context) {
  std::signal(SIGPIPE, SIG_IGN);  // an editor can go at any time; write(2) says so
  const Interruption interruption;
  editor::DescriptorStream stream(STDIN_FILENO, STDOUT_FILENO);
  editor::dap::Adapter adapter(
      stream,
      [&context](const SessionRequest& request, const Say& say, const client::Progress& progress) {
        return open_session(context, request, say, progress);
      },
      [&interruption] { return interruption.requested(); });
  return adapter.run();
}

}  // namespace

void add_dap(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("dap", "debug adapter for editors, on stdin and stdout")->fallthrough();
  command->footer(footer);
  command->callback([&context] { context.finish(run_dap(context)); });
}

}  // namespace opentmcl::app
