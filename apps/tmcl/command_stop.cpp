// tmcl stop: stop the motor.

#include <CLI/CLI.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"

namespace opentmcl::app {

using client::Result;

namespace {

struct StopOptions {
  bool program = false;
};

Result<void> run_stop(const Context& context, const StopOptions& options) {
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  // The program first: it could start the motor again.
  if (options.program) {
    if (Result<void> stopped = connection->client->stop_program(); !stopped) return stopped;
  }
  return connection->client->stop();
}

}  // namespace

void add_stop(CLI::App& app, Context& context) {
  auto options = std::make_shared<StopOptions>();
  CLI::App* command = app.add_subcommand("stop", "stop the motor along its ramp")->fallthrough();
  command->footer("Example: tmcl --port /dev/ttyACM0 stop --program");
  command->add_flag("--program", options->program, "stop the module's TMCL program too");
  command->callback([&context, options] { context.finish(run_stop(context, *options)); });
}

}  // namespace opentmcl::app
