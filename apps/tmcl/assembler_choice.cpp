#include "apps/tmcl/assembler_choice.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "lang/diagnostic_kind.hpp"
#include "lang/suggestion.hpp"

namespace opentmcl::app {

namespace {

/// None: there is no such warning.
std::optional<lang::DiagnosticKinds> warnings_named(const std::string& name) {
  if (name == lang::all_warnings_name) return lang::all_warnings();
  const std::optional<lang::DiagnosticKind> kind = lang::find_warning(name);
  if (!kind) return std::nullopt;
  return lang::DiagnosticKinds().set(lang::index_of(*kind));
}

/// What is wrong with the name of a warning, or nothing.
std::string objection_to(const std::string& name) {
  if (warnings_named(name)) return {};
  lang::Suggestion suggestion(name);
  for (const lang::DiagnosticKindSpec& row : lang::diagnostic_kinds) {
    if (row.severity == lang::Severity::warning) suggestion.consider(row.name);
  }
  const std::string hint = suggestion.name().empty() ? "tmcl asm --list-warnings prints all" : suggestion.text();
  return fmt::format("there is no warning \"{}\": {}", name, hint);
}

}  // namespace

void add_assembler_options(CLI::App& command, AssemblerChoice& choice) {
  command.add_option("-I,--include-folder", choice.include_folders, "where else to look for included files")
      ->allow_extra_args(false);
  command
      .add_option("--no-warning", choice.switched_off,
                  "switch a warning off, by its name (tmcl asm --list-warnings); \"all\" for all")
      ->check(objection_to)
      ->allow_extra_args(false);
  command.add_flag("--warnings-as-errors", choice.warnings_as_errors, "make errors of all warnings");
}

lang::AssemblerOptions assembler_options(const AssemblerChoice& choice, const ModuleDescription& module) {
  lang::AssemblerOptions options;
  options.module = &module;
  options.include_path = choice.include_folders;
  for (const std::string& name : choice.switched_off) options.switched_off |= *warnings_named(name);
  options.warnings_as_errors = choice.warnings_as_errors;
  return options;
}

}  // namespace opentmcl::app
