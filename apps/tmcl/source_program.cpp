#include "apps/tmcl/source_program.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "apps/tmcl/context.hpp"
#include "apps/tmcl/terminal.hpp"
#include "lang/diagnostic.hpp"
#include "lang/file_provider.hpp"
#include "lang/module_comment.hpp"
#include "lang/source.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

Error too_large(const std::string& path) {
  return {ErrorKind::bad_file,
          fmt::format("{} is larger than {} MiB: it is no TMCL source", path, lang::maximum_text_size >> 20U),
          {}};
}

/// Not more than one byte too much for a source.
std::string read_standard_input() {
  std::string text;
  for (char byte = 0; text.size() <= lang::maximum_text_size && std::cin.get(byte);) text.push_back(byte);
  return text;
}

}  // namespace

Result<std::string> read_file(const std::string& path) {
  if (path == standard_input) return read_standard_input();
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return Error{ErrorKind::bad_file, fmt::format("cannot read {}: it is a folder", path), {}};
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{
        ErrorKind::bad_file, fmt::format("cannot read {}: {}", path, std::generic_category().message(errno)), {}};
  }
  return std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Result<std::string> read_source(const std::string& path) {
  if (path == standard_input) {
    std::string text = read_standard_input();
    if (text.size() > lang::maximum_text_size) return too_large("standard input");
    return text;
  }
  lang::DiskFiles files;
  lang::FileContent content = files.read(path);
  switch (content.state) {
    case lang::FileContent::State::found:
      return std::move(content.text);
    case lang::FileContent::State::too_large:
      return too_large(path);
    case lang::FileContent::State::missing:
    case lang::FileContent::State::unreadable:
      break;
  }
  Result<std::string> failed = read_file(path);  // which says why
  if (failed.ok()) return Error{ErrorKind::bad_file, fmt::format("cannot read {}", path), {}};
  return failed;
}

Result<const ModuleDescription*> module_of_source(const std::string& path, const std::string& text,
                                                  const std::string& argument) {
  if (!argument.empty()) return named_module(argument);
  const Result<const ModuleDescription*> named = module_named_by(path, text);
  return named && *named == nullptr ? &pd1161 : named;
}

Result<const ModuleDescription*> module_named_by(const std::string& path, const std::string& text) {
  const std::optional<lang::ModuleComment> comment = lang::module_named_in(text);
  if (!comment) return nullptr;
  if (comment->module != nullptr) return comment->module;
  return Error{
      ErrorKind::bad_file,
      fmt::format("{} says that it is for the module {}, which is not known", path, lang::in_quotes(comment->written)),
      {}};
}

std::string summary_of(const std::string& path, const lang::AssemblyResult& result) {
  const std::string counts = lang::summary(lang::count(result.diagnostics));
  return counts.empty() ? counts : path + ": " + counts;
}

void print_diagnostics(const std::string& path, const lang::AssemblyResult& result) {
  fmt::print(stderr, "{}", lang::format(result.diagnostics, result.sources, {stderr_has_colours()}));
  // Where there are errors, the command ends with the summary.
  if (result.program && !result.diagnostics.empty()) fmt::print(stderr, "{}\n", summary_of(path, result));
}

Result<lang::AssemblyResult> assemble_file(const std::string& path, const lang::AssemblerOptions& options) {
  Result<std::string> text = read_source(path);
  if (!text) return text.error();
  return assemble_text(path, std::move(*text), options);
}

Result<lang::AssemblyResult> assemble_text(const std::string& path, std::string text,
                                           const lang::AssemblerOptions& options) {
  lang::DiskFiles files;
  lang::AssemblyResult result = lang::assemble(path, std::move(text), options, files);
  print_diagnostics(path, result);
  if (result.program) return result;
  return Error{ErrorKind::bad_file, summary_of(path, result), {}};
}

}  // namespace opentmcl::app
