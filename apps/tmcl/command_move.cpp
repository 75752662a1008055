// tmcl move: go to a position.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/interruption.hpp"

namespace opentmcl::app {

using client::Client;
using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

constexpr client::Duration poll_period = std::chrono::milliseconds(20);

struct MoveOptions {
  std::int32_t position = 0;
  bool relative = false;
  bool wait = false;
};

/// Until the position is reached; Ctrl-C stops the motor.
Result<void> wait_for_position(Client& client) {
  const Interruption interruption;
  while (true) {
    const Result<std::int32_t> reached = client.axis_parameter(AxisParameter::position_reached);
    if (!reached) return reached.error();
    if (*reached != 0) return {};
    if (interruption.requested()) {
      if (Result<void> stopped = client.stop(); !stopped) return stopped;
      return Error{ErrorKind::interrupted, "interrupted; the motor has been stopped", {}};
    }
    client.transport().pause(poll_period);
  }
}

Result<void> run_move(const Context& context, const MoveOptions& options) {
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  Client& client = *connection->client;
  Result<void> moved = options.relative ? client.move_by(options.position) : client.move_to(options.position);
  if (!moved) return moved;
  if (options.wait) {
    if (Result<void> waited = wait_for_position(client); !waited) return waited;
  }
  const Result<std::int32_t> position = client.axis_parameter(AxisParameter::actual_position);
  if (!position) return position.error();
  if (context.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"position", *position}}.dump());
  } else if (options.wait) {
    fmt::print("{}\n", *position);
  }
  return {};
}

}  // namespace

void add_move(CLI::App& app, Context& context) {
  auto options = std::make_shared<MoveOptions>();
  CLI::App* command = app.add_subcommand("move", "move the motor to a position")->fallthrough();
  command->footer("Examples:\n  tmcl move 51200 --wait\n  tmcl move --relative -- -51200");
  command->add_option("POSITION", options->position, "microsteps")->required();
  command->add_flag("--relative", options->relative, "from the actual position");
  command->add_flag("--wait", options->wait, "until it is reached, and print it then; Ctrl-C stops the motor");
  command->callback([&context, options] { context.finish(run_move(context, *options)); });
}

}  // namespace opentmcl::app
