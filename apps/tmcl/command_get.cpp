// tmcl get: read a parameter.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/parameter_name.hpp"
#include "apps/tmcl/physical_value.hpp"

namespace opentmcl::app {

using client::Result;

namespace {

struct GetOptions {
  std::string parameter;
  int bank = -1;
};

Result<void> run_get(const Context& context, const GetOptions& options) {
  const bool is_global = options.bank >= 0;
  const auto bank = static_cast<Bank>(options.bank);
  const Result<NamedParameter> parameter =
      is_global ? find_global_parameter(options.parameter, bank) : find_axis_parameter(options.parameter);
  if (!parameter) return parameter.error();
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  client::Client& client = *connection->client;
  const Result<std::int32_t> value =
      is_global ? client.global_parameter(parameter->number, bank) : client.axis_parameter(parameter->number);
  if (!value) return value.error();
  const Result<std::string> physical = physical_value(client, parameter->unit, *value);
  if (!physical) return physical.error();

  if (context.json) {
    nlohmann::ordered_json data{{"number", parameter->number},
                                {"symbol", parameter->symbol},
                                {"value", *value},
                                {"unit", name_of(parameter->unit)},
                                {"physical", *physical}};
    if (is_global) data["bank"] = options.bank;
    fmt::print("{}\n", data.dump());
  } else if (physical->empty()) {
    fmt::print("{}\n", *value);
  } else if (*physical == name_of(parameter->unit)) {
    fmt::print("{} {}\n", *value, *physical);
  } else {
    fmt::print("{} = {}\n", *value, *physical);
  }
  return {};
}

}  // namespace

void add_get(CLI::App& app, Context& context) {
  auto options = std::make_shared<GetOptions>();
  CLI::App* command = app.add_subcommand("get", "read a parameter")->fallthrough();
  command->footer(
      "Examples:\n  tmcl get actual-position\n  tmcl get 4\n  tmcl get --global 0 serial-address\n"
      "  tmcl get --global 2 7           user variable 7");
  command->add_option("PARAMETER", options->parameter, "axis parameter: a number, a symbol or a name of `tmcl spec`")
      ->required();
  command->add_option("--global", options->bank, "a global parameter of this bank instead")->check(CLI::Range(0, 3));
  command->callback([&context, options] { context.finish(run_get(context, *options)); });
}

}  // namespace opentmcl::app
