// tmcl get: read a parameter.

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

Result<void> run_get(const Context& context, const ParameterChoice& choice) {
  const Result<NamedParameter> parameter = choice.find();
  if (!parameter) return parameter.error();
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  client::Client& client = *connection->client;
  const Result<std::int32_t> value = choice.is_global() ? client.global_parameter(parameter->number, choice.bank())
                                                        : client.axis_parameter(parameter->number);
  if (!value) return value.error();
  const Result<units::PhysicalScale> scale = physical_scale(client, parameter->unit);
  if (!scale) return scale.error();

  if (context.json) {
    nlohmann::ordered_json data{{"number", parameter->number},
                                {"symbol", parameter->symbol},
                                {"value", *value},
                                {"unit", name_of(parameter->unit)},
                                {"physical", units::physical_value(parameter->unit, *value, *scale)}};
    if (choice.is_global()) data["bank"] = choice.bank_number;
    fmt::print("{}\n", data.dump());
  } else {
    fmt::print("{}\n", units::number_with_physical_value(parameter->unit, *value, *scale));
  }
  return {};
}

}  // namespace

void add_get(CLI::App& app, Context& context) {
  auto choice = std::make_shared<ParameterChoice>();
  CLI::App* command = app.add_subcommand("get", "read a parameter")->fallthrough();
  command->footer(
      "Examples:\n  tmcl get actual-position\n  tmcl get 4\n  tmcl get --global 0 serial-address\n"
      "  tmcl get --global 2 7           user variable 7");
  add_options(*command, *choice);
  command->callback([&context, choice] { context.finish(run_get(context, *choice)); });
}

}  // namespace opentmcl::app
