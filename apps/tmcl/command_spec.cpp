// tmcl spec: the tables everything else is made from.

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/spec_json.hpp"

namespace opentmcl::app {

void add_spec(CLI::App& app, Context& context) {
  CLI::App* command =
      app.add_subcommand("spec", "print all instructions, parameters, interrupts, status codes and ports")
          ->fallthrough();
  command->footer("Example: tmcl spec --json");
  command->callback([&context] { fmt::print("{}\n", context.json ? spec_as_json() : spec_as_text()); });
}

}  // namespace opentmcl::app
