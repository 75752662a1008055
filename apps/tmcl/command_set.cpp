// tmcl set: write a parameter.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/parameter_choice.hpp"
#include "apps/tmcl/physical_scale.hpp"

namespace opentmcl::app {

using client::Result;

namespace {

struct SetOptions {
  ParameterChoice choice;
  std::int32_t value = 0;
};

Result<void> run_set(const Context& context, const SetOptions& options) {
  const Result<NamedParameter> parameter = options.choice.find();
  if (!parameter) return parameter.error();
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  client::Client& client = *connection->client;
  Result<void> written = options.choice.is_global()
                             ? client.set_global_parameter(parameter->number, options.choice.bank(), options.value)
                             : client.set_axis_parameter(parameter->number, options.value);
  if (!written) return written;
  const Result<units::PhysicalScale> scale = physical_scale(client, parameter->unit);
  if (!scale) return scale.error();
  if (context.json) {
    fmt::print("{}\n",
               nlohmann::ordered_json{{"number", parameter->number},
                                      {"value", options.value},
                                      {"physical", units::physical_value(parameter->unit, options.value, *scale)}}
                   .dump());
  } else {
    fmt::print(stderr, "set to {}\n", units::number_with_physical_value(parameter->unit, options.value, *scale));
  }
  return {};
}

}  // namespace

void add_set(CLI::App& app, Context& context) {
  auto options = std::make_shared<SetOptions>();
  CLI::App* command = app.add_subcommand("set", "write a parameter")->fallthrough();
  command->footer("Examples:\n  tmcl set maximum-current 100\n  tmcl set 4 1000\n  tmcl set --global 2 7 -1");
  add_options(*command, options->choice);
  command->add_option("VALUE", options->value, "in the parameter's own unit")->required();
  command->callback([&context, options] { context.finish(run_set(context, *options)); });
}

}  // namespace opentmcl::app
