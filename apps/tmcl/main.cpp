// The program `tmcl`.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"

namespace {

constexpr const char* description =
    "Virtual stepper motor modules, and commands for virtual and real ones (TMCM-1110, PD-1161).";

constexpr const char* footer = R"(Examples:
  tmcl sim pd1161 --program examples/first_steps.tmc    a virtual module that runs a program
  tmcl --port /dev/ttyACM0 rotate 500                   turn the motor of a real one
  tmcl --port tcp://127.0.0.1:5160 get actual-position  ask a virtual one over TCP
  tmcl run my.tmc                                       try a program with nothing plugged in

Ports: a path such as /dev/ttyACM0, tcp://HOST:PORT, or sim:pd1161 and sim:tmcm1110 for a virtual module inside the
program, fresh from the factory each time.

Exit codes: 0 done, 1 the module said no or a scenario's expectation failed, 64 wrong usage, 65 bad source or file, 69 no such device, 70 internal error,
74 input/output error, 75 timeout, 76 protocol error, 130 interrupted.)";

int run(int argument_count, char** arguments) {
  using namespace opentmcl::app;
  CLI::App app(description, "tmcl");
  app.footer(footer);
  app.require_subcommand(1);
  app.fallthrough();

  Context context;
  app.add_option("-p,--port", context.port, "where the module is; environment TMCL_PORT")
      ->envname("TMCL_PORT")
      ->capture_default_str();
  app.add_option("--address", context.address, "the module's address; over USB any will do")
      ->check(CLI::Range(0, 255))
      ->capture_default_str();
  app.add_option("--timeout", context.time_limit, "how long to wait for an answer")->capture_default_str();
  app.add_flag("--json", context.json, "print data as JSON");

  add_sim(app, context);
  add_scenario(app, context);
  add_farm(app, context);
  add_asm(app, context);
  add_dis(app, context);
  add_fmt(app, context);
  add_lsp(app, context);
  add_run(app, context);
  add_debug(app, context);
  add_dap(app, context);
  add_get(app, context);
  add_set(app, context);
  add_rotate(app, context);
  add_move(app, context);
  add_stop(app, context);
  add_send(app, context);
  add_spec(app, context);
  add_version(app, context);

  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    const bool is_help = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    app.exit(error);
    return is_help ? EXIT_SUCCESS : opentmcl::client::exit_code_of(opentmcl::client::ErrorKind::usage);
  }
  // A pipe that was closed, a disk that is full.
  if (std::fflush(stdout) != 0 && context.exit_code == 0) {
    context.exit_code = opentmcl::client::exit_code_of(opentmcl::client::ErrorKind::input_output);
  }
  return context.exit_code;
}

}  // namespace

int main(int argument_count, char** arguments) {
  try {
    return run(argument_count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tmcl: internal error: %s\n", error.what());
    return opentmcl::client::exit_code_of(opentmcl::client::ErrorKind::internal);
  }
}
