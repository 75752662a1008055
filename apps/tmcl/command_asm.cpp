// tmcl asm: TMCL source to the binary file TMCL-IDE writes.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/source_program.hpp"
#include "lang/listing.hpp"
#include "lang/program_file.hpp"

namespace opentmcl::app {

using client::Result;

namespace {

struct AsmOptions {
  std::string file;
  std::string output;
  std::string module = pd1161.argument;
  std::string listing;
  std::vector<std::string> include_folders;
  bool no_append_stop = false;
};

Result<void> run_asm(const Context& context, const AsmOptions& options) {
  const Result<const ModuleDescription*> module = named_module(options.module);
  if (!module) return module.error();
  lang::AssemblerOptions assembler;
  assembler.module = *module;
  assembler.append_stop = !options.no_append_stop;
  assembler.include_path = options.include_folders;
  const Result<lang::AssemblyResult> assembled = assemble_file(options.file, assembler);
  if (!assembled) return assembled.error();
  const lang::Program& program = *assembled->program;

  const std::string output =
      options.output.empty() ? std::filesystem::path(options.file).replace_extension(".bin").string() : options.output;
  const std::vector<std::uint8_t> bytes = lang::to_program_file(program.commands);
  if (auto written = write_file(output, {bytes.begin(), bytes.end()}); !written) return written;
  if (!options.listing.empty()) {
    const std::string listing = lang::listing(program, assembled->sources);
    if (options.listing == "-") {
      fmt::print("{}", listing);
    } else if (auto written = write_file(options.listing, listing); !written) {
      return written;
    }
  }
  if (context.json) {
    nlohmann::ordered_json labels = nlohmann::ordered_json::object();
    for (const lang::Label& label : program.labels) labels[label.name] = label.address;
    fmt::print("{}\n", nlohmann::ordered_json{{"file", output},
                                              {"module", (*module)->name},
                                              {"instructions", program.commands.size()},
                                              {"labels", labels}}
                           .dump());
  } else {
    fmt::print(stderr, "{}: {} of {} instructions of the {}\n", output, program.commands.size(),
               (*module)->program_capacity, (*module)->name);
  }
  return {};
}

}  // namespace

void add_asm(CLI::App& app, Context& context) {
  auto options = std::make_shared<AsmOptions>();
  CLI::App* command = app.add_subcommand("asm", "assemble a TMCL program")->fallthrough();
  command->footer("Example: tmcl asm my.tmc -o my.bin --listing -");
  command->add_option("FILE", options->file, "TMCL source")->required();
  command->add_option("-o,--output", options->output, "binary file, 8 bytes an instruction; default: FILE with .bin");
  command->add_option("--module", options->module, "pd1161 or tmcm1110")->capture_default_str();
  command->add_option("--listing", options->listing, "write addresses and bytes beside the source; - for stdout");
  command->add_option("-I,--include-folder", options->include_folders, "where else to look for included files");
  command->add_flag("--no-append-stop", options->no_append_stop, "do not add a STOP at the end");
  command->callback([&context, options] { context.finish(run_asm(context, *options)); });
}

}  // namespace opentmcl::app
