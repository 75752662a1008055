// tmcl fmt: TMCL sources in the common style.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "apps/tmcl/file_replacement.hpp"
#include "apps/tmcl/source_program.hpp"
#include "apps/tmcl/unified_diff.hpp"
#include "lang/formatter.hpp"

namespace opentmcl::app {

using client::Result;

namespace {

/// As of a module that says no: nothing failed, but the answer is not the wanted one.
constexpr int would_change_exit_code = 1;

struct FmtOptions {
  std::vector<std::string> files;
  bool check = false;
  bool diff = false;
  bool to_stdout = false;
};

Result<void> replace_file(const std::string& path, const std::string& content) {
  Result<FileReplacement> replacement = FileReplacement::write(path, content);
  return replacement ? replacement->take_place() : Result<void>(replacement.error());
}

/// One file after the other, whatever is wrong with those before.
class FormatRun {
 public:
  FormatRun(Context& context, const FmtOptions& options) : context_(context), options_(options) {}

  void add(const std::string& path) {
    const Result<std::string> source = read_source(path);
    if (!source) return context_.finish(source.error());
    const lang::Formatting formatting = lang::formatting_of(*source);
    const bool changes = !formatting.edits.empty();
    any_changes_ = any_changes_ || changes;
    warn_of_untouched_lines(path, formatting);

    const bool shows_text = options_.to_stdout || (path == standard_input && !options_.check && !options_.diff);
    if (context_.json) {
      add_to_json(path, *source, formatting, shows_text);
    } else if (shows_text) {
      fmt::print("{}", formatting.text);
    } else if (options_.diff) {
      fmt::print("{}", unified_diff(path, *source, formatting.edits));
    } else if (options_.check && changes) {
      fmt::print("{}\n", path);
    }
    const bool writes = !options_.check && !options_.diff && !shows_text;
    if (writes && changes) context_.finish(replace_file(path, formatting.text));
  }

  void end() {
    if (context_.json) fmt::print("{}\n", json_.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    if (options_.check && any_changes_ && context_.exit_code == 0) context_.exit_code = would_change_exit_code;
  }

 private:
  static void warn_of_untouched_lines(const std::string& path, const lang::Formatting& formatting) {
    const std::vector<std::size_t>& lines = formatting.untouched_lines;
    if (lines.empty()) return;
    fmt::print(stderr, "{}:{}: left as it is{}: not a line of TMCL; `tmcl asm` says why\n", path, lines.front(),
               lines.size() > 1 ? fmt::format(", with {} more lines", lines.size() - 1) : "");
  }

  void add_to_json(const std::string& path, const std::string& source, const lang::Formatting& formatting,
                   bool shows_text) {
    nlohmann::ordered_json entry{
        {"file", path}, {"changed", !formatting.edits.empty()}, {"untouched_lines", formatting.untouched_lines}};
    if (shows_text) entry["text"] = formatting.text;
    if (options_.diff) entry["diff"] = unified_diff(path, source, formatting.edits);
    json_.push_back(std::move(entry));
  }

  Context& context_;
  const FmtOptions& options_;
  bool any_changes_ = false;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::array();
};

void run_fmt(Context& context, const FmtOptions& options) {
  FormatRun run(context, options);
  for (const std::string& path : options.files) run.add(path);
  run.end();
}

}  // namespace

void add_fmt(CLI::App& app, Context& context) {
  auto options = std::make_shared<FmtOptions>();
  CLI::App* command = app.add_subcommand("fmt", "format TMCL sources")->fallthrough();
  command->footer(
      "Examples:\n  tmcl fmt my.tmc                 format the file\n"
      "  tmcl fmt --check *.tmc          list those not formatted; exit code 1 if there are any\n"
      "  tmcl fmt --diff my.tmc          show what would change\n"
      "  tmcl fmt - < my.tmc             from standard input to standard output\n\n"
      "The style: docs/formatting.md. The program stays the same; lines that are no TMCL stay as they are.");
  command->add_option("FILE", options->files, "TMCL sources; - for standard input")->required();
  CLI::Option* check = command->add_flag("--check", options->check, "write nothing, list the files that would change");
  CLI::Option* diff = command->add_flag("--diff", options->diff, "write nothing, show the changes as a unified diff");
  CLI::Option* to_stdout =
      command->add_flag("--stdout", options->to_stdout, "write nothing, print the formatted sources");
  to_stdout->excludes(check)->excludes(diff);
  command->callback([&context, options] { run_fmt(context, *options); });
}

}  // namespace opentmcl::app
