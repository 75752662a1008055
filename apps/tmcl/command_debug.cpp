// tmcl debug: a TMCL program step by step, in a module or in a twin that can go back in time.

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/debug_session.hpp"
#include "apps/tmcl/interruption.hpp"
#include "apps/tmcl/line_editor.hpp"
#include "apps/tmcl/quantity.hpp"
#include "apps/tmcl/scenario_source.hpp"
#include "apps/tmcl/status_line.hpp"
#include "debug/console/console.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using debug::Console;

namespace {

struct DebugOptions {
  DebugRequest request;
  bool attach = false;
  bool trust = false;
  bool batch = false;
  std::string limit;
  std::vector<std::string> commands;
};

constexpr LoadingAdvice advice{"without --attach the source is loaded", "--trust"};

/// A motion in a script that nobody watches.
constexpr client::Duration usual_limit_of_scripts = std::chrono::minutes(1);

/// Where the commands come from.
class Lines {
 public:
  virtual ~Lines() = default;
  /// @return false at the end. Error: interrupted (Ctrl-C).
  virtual Result<bool> next(const Console& console, std::string& line) = 0;
};

/// The commands of the command line or, without any, what comes from standard input.
class ScriptLines final : public Lines {
 public:
  ScriptLines(std::vector<std::string> commands, const Interruption& interruption)
      : commands_(std::move(commands)), interruption_(interruption) {}

  Result<bool> next(const Console&, std::string& line) override {
    if (!commands_.empty()) {
      if (given_ == commands_.size()) return false;
      line = commands_[given_++];
      return true;
    }
    while (true) {
      const std::size_t end = buffer_.find('\n');
      if (end != std::string::npos || (at_end_ && !buffer_.empty())) {
        line = buffer_.substr(0, end);
        buffer_.erase(0, end == std::string::npos ? end : end + 1);
        return true;
      }
      if (at_end_) return false;
      if (Result<void> read = read_some(); !read) return read.error();
    }
  }

 private:
  /// By poll(), which a signal interrupts; now and then it looks whether one came just before.
  Result<void> read_some() {
    constexpr int now_and_then = 200;  // ms
    constexpr std::size_t longest_line = 1 << 20;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = ::poll(&input, 1, now_and_then);
    if (interruption_.take()) return Error{ErrorKind::interrupted, "interrupted", {}};
    if (ready <= 0) return {};
    char bytes[4096];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    at_end_ = count <= 0;
    if (count > 0) buffer_.append(bytes, static_cast<std::size_t>(count));
    if (buffer_.size() <= longest_line || buffer_.find('\n') != std::string::npos) return {};
    return Error{ErrorKind::usage, "standard input has a line of more than 1 MiB: that is no script", {}};
  }

  std::vector<std::string> commands_;
  std::size_t given_ = 0;
  const Interruption& interruption_;
  std::string buffer_;
  bool at_end_ = false;
};

class TerminalLines final : public Lines {
 public:
  TerminalLines(const Console& console, const Interruption& interruption, std::string history_file)
      : interruption_(interruption),
        editor_([&console](std::string_view line) { return console.completions(line); }, std::move(history_file)) {}

  Result<bool> next(const Console& console, std::string& line) override {
    LineEditor::Answer answer = editor_.read(console.prompt(), [this] { return interruption_.take(); });
    if (answer.outcome == LineEditor::Outcome::interrupted) return Error{ErrorKind::interrupted, "interrupted", {}};
    line = std::move(answer.line);
    return answer.outcome == LineEditor::Outcome::line;
  }

 private:
  const Interruption& interruption_;
  LineEditor editor_;
};

/// Where the history of lines is kept; empty: nowhere.
std::string history_path() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  if (state == nullptr && home == nullptr) return {};
  const std::filesystem::path folder =
      (state != nullptr ? std::filesystem::path(state) : std::filesystem::path(home) / ".local" / "state") / "tmcl";
  std::error_code cannot;
  std::filesystem::create_directories(folder, cannot);
  return cannot ? std::string() : (folder / "debug_history").string();
}

bool wants_colours() {
  const char* const no_color = std::getenv("NO_COLOR");
  return ::isatty(STDOUT_FILENO) != 0 && (no_color == nullptr || *no_color == '\0');
}

void print_out(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

void print_error(const Error& error) {
  std::fflush(stdout);
  fmt::print(stderr, "tmcl: {}\n", error.message);
}

/// Errors of a person's typing leave the session as it is; without a connection there is none.
bool ends_session(const Error& error) {
  return error.kind == ErrorKind::input_output || error.kind == ErrorKind::internal;
}

Result<Console::Outcome> talk(Console& console, Lines& lines, bool interactive) {
  bool interrupted_before = false;
  while (true) {
    std::string line;
    const Result<bool> has_line = lines.next(console, line);
    if (!has_line) {
      if (!interactive || has_line.error().kind != ErrorKind::interrupted) return has_line.error();
      if (interrupted_before) return Error{ErrorKind::interrupted, "interrupted", {}};
      interrupted_before = true;
      fmt::print(stderr, "Ctrl-C again ends the session; so does quit\n");
      continue;
    }
    interrupted_before = false;
    if (!*has_line) return Console::Outcome::quit;
    Result<Console::Outcome> outcome = console.execute(line);
    if (outcome) {
      if (*outcome != Console::Outcome::done) return outcome;
      continue;
    }
    if (!interactive || ends_session(outcome.error())) return outcome;
    print_error(outcome.error());
  }
}

client::Progress progress_of(StatusLine& line, const Interruption& interruption) {
  return [&line, &interruption](std::size_t done, std::size_t total) {
    if (line.is_terminal()) line.show(fmt::format("program memory: {} of {} instructions", done, total));
    return !interruption.requested();
  };
}

Result<void> run_debug(const Context& context, const DebugOptions& options) {
  const bool interactive = options.commands.empty() && !options.batch && ::isatty(STDIN_FILENO) != 0;
  std::optional<client::Duration> limit;
  if (!options.limit.empty()) {
    const Result<Microseconds> duration = parse_duration(options.limit);
    if (!duration) return duration.error();
    limit = client::Duration(*duration);
  } else if (!interactive) {
    limit = usual_limit_of_scripts;
  }

  const Interruption interruption;
  StatusLine status;
  DebugListeners listeners;
  listeners.diagnostics = [](const std::string& text) { fmt::print(stderr, "{}", text); };
  listeners.reports = [&](const scenario::Report& report) {
    print_report(report, options.request.scenario, context.json);
  };
  const client::Progress progress = progress_of(status, interruption);
  Result<DebugSession> session = open_debug_session(context, options.request, listeners, progress);
  if (!session) return session.error();

  Console* listener = nullptr;
  debug::Engine engine(*session->target, *std::move(session->program),
                       [&listener](const std::string& text) { listener->show_output(text); });
  Console::Surroundings surroundings;
  surroundings.print = print_out;
  bool was_interrupted = false;
  surroundings.take_interruption = [&] {
    const bool taken = interruption.take();
    was_interrupted = was_interrupted || taken;
    return taken;
  };
  surroundings.sleep = [](std::chrono::milliseconds time) { std::this_thread::sleep_for(time); };
  if (interactive && status.is_terminal()) {
    surroundings.show_progress = [&status](const std::string& text) {
      status.show(text);
      if (text.empty()) status.forget();
    };
  }
  Console console(engine, std::move(surroundings), {wants_colours(), context.json, limit});
  listener = &console;

  const Loading loading = options.trust ? Loading::trust : options.attach ? Loading::attach : Loading::download;
  const Result<std::string> loaded = load_program(engine, loading, advice, progress);
  status.end();
  if (!loaded) return loaded.error();
  if (engine.target().twin() == nullptr) fmt::print(stderr, "{}: {}\n", context.port, *loaded);
  if (!engine.is_running()) console.show_stop(engine.stop());
  if (interactive) fmt::print(stderr, "`help` lists the commands.\n");

  std::unique_ptr<Lines> lines;
  if (interactive) {
    lines = std::make_unique<TerminalLines>(console, interruption, history_path());
  } else {
    lines = std::make_unique<ScriptLines>(options.commands, interruption);
  }
  const Result<Console::Outcome> outcome = talk(console, *lines, interactive);
  lines.reset();
  // A twin ends with this program; a module is not left to a program that nobody watches any more.
  if (engine.target().twin() == nullptr) {
    const bool runs_on = outcome && *outcome == Console::Outcome::detach;
    Result<void> left = runs_on ? engine.detach() : engine.stop_all();
    if (!left && outcome) return left;
    if (left) fmt::print(stderr, "{}\n", runs_on ? "the program runs on" : "program and motor have been stopped");
  }
  if (!outcome) return outcome.error();
  if (!interactive && was_interrupted) return Error{ErrorKind::interrupted, "interrupted", {}};
  return {};
}

}  // namespace

void add_debug(CLI::App& app, Context& context) {
  auto options = std::make_shared<DebugOptions>();
  CLI::App* command =
      app.add_subcommand("debug", "debug a TMCL program, in a virtual module or a real one")->fallthrough();
  command->footer(
      "Examples:\n"
      "  tmcl debug my.tmc                              in a virtual module, forward and back\n"
      "  tmcl debug my.tmc --scenario bench.toml        with a bench around it\n"
      "  tmcl --port /dev/ttyACM0 debug my.tmc          in a real module: what differs is loaded first\n"
      "  tmcl --port /dev/ttyACM0 debug my.tmc --attach the program that runs there\n"
      "  tmcl debug my.tmc -e 'break Loop' -e run -e 'print A'\n\n"
      "`help` inside lists the commands; docs/debugger.md has a session. Commands also come from standard input; then\n"
      "the first error ends the session with its exit code. Ctrl-C pauses the program, a second one ends the session.");
  command->add_option("FILE", options->request.file,
                      "TMCL source; without one the scenario's program, or what a module has");
  command->add_option("--module", options->request.module, "pd1161 or tmcm1110; default: what the port says");
  command->add_option("--scenario", options->request.scenario, "the bench around a virtual module");
  add_assembler_options(*command, options->request.assembler);
  command->add_flag("--attach", options->attach, "load nothing: the program is in the module, running or not");
  command->add_flag("--trust", options->trust, "as --attach, and do not compare the program with the source");
  command->add_flag("--batch", options->batch,
                    "take commands from standard input without a prompt, even from a terminal");
  command->add_option("-e,--execute", options->commands, "a command; can be given several times, none is asked for")
      ->allow_extra_args(false);
  command->add_option("--limit", options->limit,
                      "how long the program may run at a time, on the module's clock: 5s; default: 1min for scripts");
  command->callback([&context, options] { context.finish(run_debug(context, *options)); });
}

}  // namespace opentmcl::app
