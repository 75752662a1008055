// tmcl dis: a binary program, or the one in a module, back to source.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/interruption.hpp"
#include "apps/tmcl/source_program.hpp"
#include "apps/tmcl/status_line.hpp"
#include "client/program_transfer.hpp"
#include "lang/disassembler.hpp"
#include "lang/program_file.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

struct DisOptions {
  std::string file;
  std::string module;
  bool no_comments = false;
};

/// A program without its source.
struct BinaryProgram {
  std::vector<Command> commands;
  const ModuleDescription* module;
  std::string origin;  ///< for messages
};

Result<BinaryProgram> read_program_file(const DisOptions& options) {
  const Result<const ModuleDescription*> module =
      options.module.empty() ? Result<const ModuleDescription*>(&pd1161) : named_module(options.module);
  if (!module) return module.error();
  const Result<std::string> content = read_file(options.file);
  if (!content) return content.error();
  lang::ProgramFileResult program = lang::from_program_file({content->begin(), content->end()});
  if (!program.commands) return Error{ErrorKind::bad_file, fmt::format("{}: {}", options.file, program.error), {}};
  return BinaryProgram{*std::move(program.commands), *module, options.file};
}

Result<BinaryProgram> read_module(const Context& context, const DisOptions& options) {
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  const Result<const ModuleDescription*> module = chosen_module(options.module, *connection->client);
  if (!module) return module.error();
  StatusLine line;
  const Interruption interruption;
  const auto progress = [&](std::size_t done, std::size_t most) {
    if (line.is_terminal()) line.show(fmt::format("reading instruction {} of {} at most", done, most));
    return !interruption.requested();
  };
  Result<std::vector<Command>> commands =
      client::read_program(*connection->client, (*module)->program_capacity, progress);
  if (!commands) return commands.error();
  return BinaryProgram{*std::move(commands), *module, context.port};
}

nlohmann::ordered_json to_json(const BinaryProgram& program, const lang::Disassembly& disassembly) {
  nlohmann::ordered_json problems = nlohmann::ordered_json::array();
  for (const lang::Inexpressible& problem : disassembly.problems) {
    problems.push_back({{"address", problem.address}, {"reason", problem.reason}});
  }
  return {{"module", program.module->name},
          {"instructions", program.commands.size()},
          {"source", disassembly.text},
          {"problems", problems}};
}

Result<void> run_dis(const Context& context, const DisOptions& options) {
  const Result<BinaryProgram> program =
      options.file.empty() ? read_module(context, options) : read_program_file(options);
  if (!program) return program.error();
  const lang::Comments comments = options.no_comments ? lang::Comments::none : lang::Comments::meanings;
  const lang::Disassembly disassembly = lang::disassemble(program->commands, *program->module, comments);
  if (context.json) {
    fmt::print("{}\n", to_json(*program, disassembly).dump());
  } else {
    fmt::print("{}", disassembly.text);
  }
  for (const lang::Inexpressible& problem : disassembly.problems) {
    fmt::print(stderr, "{}: instruction {}: {}\n", program->origin, problem.address, problem.reason);
  }
  if (disassembly.problems.empty()) return {};
  return Error{ErrorKind::bad_file,
               fmt::format("{}: {} instruction{} no form in TMCL source for the {}; the text is for reading only",
                           program->origin, disassembly.problems.size(),
                           disassembly.problems.size() == 1 ? " has" : "s have", program->module->name),
               {}};
}

}  // namespace

void add_dis(CLI::App& app, Context& context) {
  auto options = std::make_shared<DisOptions>();
  CLI::App* command = app.add_subcommand("dis", "disassemble a binary program, or the one in a module")->fallthrough();
  command->footer(
      "Examples:\n  tmcl dis my.bin --module tmcm1110 > my.tmc\n"
      "  tmcl --port /dev/ttyACM0 dis    the program in the module, from address 0 to its end\n\n"
      "`tmcl asm --no-append-stop` makes the same binary of the source again. Physical values in comments hold for "
      "the\n"
      "module's factory settings and what the program itself sets.");
  command->add_option("FILE", options->file,
                      "binary file, 8 bytes an instruction; - for standard input; without it the module at --port");
  command->add_option("--module", options->module,
                      "pd1161 or tmcm1110; default: what the module says, for a file pd1161");
  command->add_flag("--no-comments", options->no_comments, "without names of parameters and physical values");
  command->callback([&context, options] { context.finish(run_dis(context, *options)); });
}

}  // namespace opentmcl::app
