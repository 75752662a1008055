// tmcl dis: a binary program back to source.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/source_program.hpp"
#include "lang/disassembler.hpp"
#include "lang/program_file.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

struct DisOptions {
  std::string file;
  std::string module = pd1161.argument;
};

Result<void> run_dis(const Context& context, const DisOptions& options) {
  const Result<const ModuleDescription*> module = named_module(options.module);
  if (!module) return module.error();
  const Result<std::string> content = read_file(options.file);
  if (!content) return content.error();
  const lang::ProgramFileResult program = lang::from_program_file({content->begin(), content->end()});
  if (!program.commands) return Error{ErrorKind::bad_file, fmt::format("{}: {}", options.file, program.error), {}};

  const lang::Disassembly disassembly = lang::disassemble(*program.commands, **module);
  if (context.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"module", (*module)->name},
                                              {"instructions", program.commands->size()},
                                              {"source", disassembly.text}}
                           .dump());
  } else {
    fmt::print("{}", disassembly.text);
  }
  for (const lang::Inexpressible& problem : disassembly.problems) {
    fmt::print(stderr, "{}: instruction {}: {}\n", options.file, problem.address, problem.reason);
  }
  if (disassembly.problems.empty()) return {};
  return Error{ErrorKind::bad_file,
               fmt::format("{}: {} instructions have no form in TMCL source for the {}", options.file,
                           disassembly.problems.size(), (*module)->name),
               {}};
}

}  // namespace

void add_dis(CLI::App& app, Context& context) {
  auto options = std::make_shared<DisOptions>();
  CLI::App* command = app.add_subcommand("dis", "disassemble a binary program")->fallthrough();
  command->footer("Example: tmcl dis my.bin --module tmcm1110 > my.tmc");
  command->add_option("FILE", options->file, "binary file, 8 bytes an instruction")->required();
  command->add_option("--module", options->module, "pd1161 or tmcm1110")->capture_default_str();
  command->callback([&context, options] { context.finish(run_dis(context, *options)); });
}

}  // namespace opentmcl::app
