// tmcl version: of this program, and of a module.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"

namespace opentmcl::app {

using client::Result;

namespace {

Result<void> run_version(const Context& context, bool ask_module) {
  nlohmann::ordered_json data{{"tmcl", OPENTMCL_VERSION}};
  std::string text = fmt::format("tmcl {}\n", OPENTMCL_VERSION);
  if (ask_module) {
    const Result<Connection> connection = context.connect();
    if (!connection) return connection.error();
    const Result<client::FirmwareVersion> version = connection->client->firmware_version();
    if (!version) return version.error();
    const Result<std::string> version_text = connection->client->firmware_version_text();
    if (!version_text) return version_text.error();
    const ModuleDescription* module = version->module();
    const std::string name = module != nullptr ? module->name : fmt::format("type {}", version->type_number);
    data["module"] = name;
    data["firmware"] = fmt::format("{}.{:02}", version->major, version->minor);
    data["text"] = *version_text;
    text += fmt::format("{}: {}, firmware V{}.{:02} ({})\n", context.port, name, version->major, version->minor,
                        *version_text);
  }
  fmt::print("{}", context.json ? data.dump() + "\n" : text);
  return {};
}

}  // namespace

void add_version(CLI::App& app, Context& context) {
  CLI::App* command =
      app.add_subcommand("version", "the version of tmcl and, with --port, of the module")->fallthrough();
  command->footer("Example: tmcl version --port /dev/ttyACM0");
  command->callback([&context, &app] {
    const bool port_was_given = app.get_option("--port")->count() > 0;
    context.finish(run_version(context, port_was_given));
  });
}

}  // namespace opentmcl::app
