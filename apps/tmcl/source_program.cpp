#include "apps/tmcl/source_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "lang/diagnostic.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

Result<std::string> read_file(const std::string& path) {
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

Result<void> write_file(const std::string& path, const std::string& content) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (file) return {};
  return Error{
      ErrorKind::input_output, fmt::format("cannot write {}: {}", path, std::generic_category().message(errno)), {}};
}

Result<lang::AssemblyResult> assemble_file(const std::string& path, const lang::AssemblerOptions& options) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  lang::DiskFiles files;
  lang::AssemblyResult result = lang::assemble(path, *text, options, files);
  fmt::print(stderr, "{}", lang::format(result.diagnostics, result.sources));
  if (result.program) return result;
  const auto errors = std::count_if(result.diagnostics.begin(), result.diagnostics.end(), [](const auto& diagnostic) {
    return diagnostic.severity() == lang::Severity::error;
  });
  return Error{ErrorKind::bad_file, fmt::format("{} has {} error{}", path, errors, errors == 1 ? "" : "s"), {}};
}

}  // namespace opentmcl::app
