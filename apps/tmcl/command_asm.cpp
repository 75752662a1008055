// tmcl asm: TMCL source to the binary file TMCL-IDE writes, and what else a program can become.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/tmcl/assembler_choice.hpp"
#include "apps/tmcl/assembly_json.hpp"
#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/output_files.hpp"
#include "apps/tmcl/source_program.hpp"
#include "lang/c_array.hpp"
#include "lang/listing.hpp"
#include "lang/program_file.hpp"
#include "lang/symbol_file.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;
using Json = nlohmann::ordered_json;

namespace {

struct AsmOptions {
  std::string file;
  std::string module;
  std::string output;
  std::string listing;
  std::string symbols;
  std::string source_map;
  std::string c_array;
  AssemblerChoice assembler;
  bool no_append_stop = false;
  bool list_warnings = false;
};

void list_warnings(const Context& context) {
  if (context.json) {
    fmt::print("{}\n", warnings_as_json().dump());
    return;
  }
  for (const lang::DiagnosticKindSpec& row : lang::diagnostic_kinds) {
    if (row.severity == lang::Severity::warning) fmt::print("{:28} {}\n", row.name, row.summary);
  }
}

/// The files of the options; the binary is always one of them.
OutputFiles outputs(const AsmOptions& options, const std::string& binary, const lang::AssemblyResult& result,
                    const ModuleDescription& module) {
  const lang::Program& program = *result.program;
  OutputFiles files;
  const std::vector<std::uint8_t> bytes = lang::to_program_file(program.commands);
  files.add(binary, {bytes.begin(), bytes.end()});
  if (!options.listing.empty()) files.add(options.listing, lang::listing(program, result.sources));
  if (!options.symbols.empty()) files.add(options.symbols, lang::symbol_file(result, module));
  if (!options.source_map.empty()) files.add(options.source_map, source_map_as_json(program, result.sources, module));
  if (!options.c_array.empty()) {
    const std::string name = std::filesystem::path(options.file).stem().string() + "_program";
    files.add(options.c_array, lang::c_array(program, result.sources, module, name));
  }
  return files;
}

/// A source called my.bin, or an option that names the source by mistake.
Result<void> check_outputs(const AsmOptions& options, const std::string& binary) {
  for (const std::string& path : {binary, options.listing, options.symbols, options.source_map, options.c_array}) {
    std::error_code error;
    if (!path.empty() && std::filesystem::equivalent(path, options.file, error)) {
      return Error{ErrorKind::usage, fmt::format("{} is the source and would be overwritten", path), {}};
    }
  }
  return {};
}

Json json_of(const lang::AssemblyResult& result, const ModuleDescription& module, const std::string& binary) {
  Json json = Json::object();
  if (result.program) {
    Json labels = Json::object();
    for (const lang::Label& label : result.program->labels) labels[label.name] = label.address;
    json = {{"file", lang::to_utf8(binary)},
            {"module", module.name},
            {"instructions", result.program->commands.size()},
            {"labels", labels}};
  } else {
    json = {{"module", module.name}};
  }
  json["diagnostics"] = diagnostics_as_json(result.diagnostics, result.sources);
  return json;
}

Result<void> run_asm(const Context& context, const AsmOptions& options) {
  if (options.list_warnings) {
    list_warnings(context);
    return {};
  }
  if (options.file.empty()) return Error{ErrorKind::usage, "FILE is required: the source to assemble", {}};
  if (!options.module.empty()) {
    if (const auto named = named_module(options.module); !named) return named.error();
  }
  Result<std::string> text = read_source(options.file);
  if (!text) return text.error();
  const Result<const ModuleDescription*> module = module_of_source(options.file, *text, options.module);
  if (!module) return module.error();

  lang::AssemblerOptions assembler = assembler_options(options.assembler, **module);
  assembler.append_stop = !options.no_append_stop;
  if (options.file == standard_input && options.output.empty()) {
    return Error{ErrorKind::usage, "a source from standard input has no name: name the binary file with -o", {}};
  }
  const std::string binary =
      options.output.empty() ? std::filesystem::path(options.file).replace_extension(".bin").string() : options.output;
  if (Result<void> checked = check_outputs(options, binary); !checked) return checked;
  lang::DiskFiles files;
  const lang::AssemblyResult result = lang::assemble(options.file, std::move(*text), assembler, files);

  if (!context.json) print_diagnostics(options.file, result);
  if (result.program) {
    if (Result<void> written = outputs(options, binary, result, **module).write(); !written) return written;
  }
  if (context.json) fmt::print("{}\n", json_of(result, **module, binary).dump());
  if (!result.program) return Error{ErrorKind::bad_file, summary_of(options.file, result), {}};
  if (!context.json) {
    fmt::print(stderr, "{}: {} of {} instructions of the {}\n", binary, result.program->commands.size(),
               (*module)->program_capacity, (*module)->name);
  }
  return {};
}

}  // namespace

void add_asm(CLI::App& app, Context& context) {
  auto options = std::make_shared<AsmOptions>();
  CLI::App* command = app.add_subcommand("asm", "assemble a TMCL program")->fallthrough();
  command->footer(
      "Examples:\n"
      "  tmcl asm my.tmc                                  writes my.bin\n"
      "  tmcl asm my.tmc -o my.bin --listing - --symbols my.sym\n"
      "  tmcl asm my.tmc -o /dev/null --c-array my.h      a header for programs in C\n"
      "  tmcl asm my.tmc --no-warning unused-label --warnings-as-errors\n\n"
      "The module a program is for can stand in its first lines: // module: tmcm1110\n"
      "FILE can be -, which is standard input; the files that are written can be -, which is standard output.\n"
      "With errors none is written.");
  command->add_option("FILE", options->file, "TMCL source; - for standard input");
  command->add_option("-o,--output", options->output, "binary file, 8 bytes an instruction; default: FILE with .bin");
  command->add_option("--module", options->module, "pd1161 or tmcm1110; default: what FILE says, else pd1161");
  command->add_option("--listing", options->listing, "write addresses and bytes beside the source");
  command->add_option("--symbols", options->symbols, "write labels and constants, as TMCL to include");
  command->add_option("--source-map", options->source_map, "write the place of each instruction as JSON");
  command->add_option("--c-array", options->c_array, "write a header for C and C++ with the program as an array");
  add_assembler_options(*command, options->assembler);
  command->add_flag("--no-append-stop", options->no_append_stop, "do not add a STOP at the end");
  command->add_flag("--list-warnings", options->list_warnings, "print the names of all warnings");
  command->callback([&context, options] { context.finish(run_asm(context, *options)); });
}

}  // namespace opentmcl::app
