// tmcl rotate: turn the motor at constant speed.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/physical_scale.hpp"
#include "firmware/spec/instructions.hpp"

namespace opentmcl::app {

using client::Result;

namespace {

constexpr OperandSpec velocity_range =
    find_instruction(static_cast<std::uint8_t>(Opcode::ror), ModuleId::pd1161)->operands[1];

Result<void> run_rotate(const Context& context, std::int32_t velocity) {
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  client::Client& client = *connection->client;
  if (Result<void> rotated = client.rotate(velocity); !rotated) return rotated;
  const Result<units::PhysicalScale> scale = physical_scale(client, Unit::internal_velocity);
  if (!scale) return scale.error();
  if (context.json) {
    fmt::print("{}\n",
               nlohmann::ordered_json{{"velocity", velocity},
                                      {"physical", units::physical_value(Unit::internal_velocity, velocity, *scale)}}
                   .dump());
  } else {
    fmt::print(stderr, "rotating at {}\n",
               units::number_with_physical_value(Unit::internal_velocity, velocity, *scale));
  }
  return {};
}

}  // namespace

void add_rotate(CLI::App& app, Context& context) {
  auto velocity = std::make_shared<std::int32_t>(0);
  CLI::App* command = app.add_subcommand("rotate", "turn the motor at constant speed")->fallthrough();
  command->footer("Examples:\n  tmcl rotate 500\n  tmcl rotate -- -500      to the left");
  command->add_option("VELOCITY", *velocity, "internal units; negative turns left")
      ->required()
      ->check(CLI::Range(velocity_range.minimum, velocity_range.maximum));
  command->callback([&context, velocity] { context.finish(run_rotate(context, *velocity)); });
}

}  // namespace opentmcl::app
