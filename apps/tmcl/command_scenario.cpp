// tmcl scenario: what scenarios can say, and whether a file says it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "apps/tmcl/assembler_choice.hpp"
#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/scenario_source.hpp"
#include "apps/tmcl/source_program.hpp"
#include "scenario/schema.hpp"

namespace opentmcl::app {

namespace {

/// Also assembles the program.
client::Result<void> check_scenario(const std::string& path, const AssemblerChoice& choice) {
  const client::Result<ScenarioSource> source = scenario_from_file(path);
  if (!source) return source.error();
  const std::string program = program_path(source->scenario, path);
  if (program.empty()) return {};
  const client::Result<lang::AssemblyResult> assembled =
      assemble_file(program, assembler_options(choice, *source->scenario.module));
  if (!assembled) return assembled.error();
  return {};
}

}  // namespace

void add_scenario(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("scenario", "check scenario files; what can stand in them")
                          ->fallthrough()
                          ->require_subcommand(1);
  command->footer("To run one: tmcl sim --scenario FILE\nExample: tmcl scenario check examples/scenarios/*.toml");

  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* check = command->add_subcommand("check", "find all mistakes in scenario files")->fallthrough();
  check->add_option("FILE", *files, "scenarios, in TOML")->required();
  auto choice = std::make_shared<AssemblerChoice>();
  add_assembler_options(*check, *choice);
  check->callback([&context, files, choice] {
    for (const std::string& file : *files) context.finish(check_scenario(file, *choice));
  });

  command->add_subcommand("schema", "print the JSON schema of scenario files")->fallthrough()->callback([] {
    fmt::print("{}", scenario::scenario_schema());
  });
  command->add_subcommand("signals", "print what can be looked at, recorded and changed")->fallthrough()->callback([] {
    fmt::print("{}", scenario::signals_document());
  });
}

}  // namespace opentmcl::app
