#include "apps/tmcl/output_files.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "apps/tmcl/file_replacement.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

constexpr const char* stdout_path = "-";

Error cannot_write(const std::string& path, const std::string& reason) {
  return {ErrorKind::input_output, fmt::format("cannot write {}: {}", path, reason), {}};
}

/// For what nobody can replace: a device, a pipe.
Result<void> write_into(const std::string& path, const std::string& content) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (file) return {};
  return cannot_write(path, std::generic_category().message(errno));
}

}  // namespace

void OutputFiles::add(std::string path, std::string content) {
  files_.push_back({std::move(path), std::move(content)});
}

Result<void> OutputFiles::write() const {
  std::vector<FileReplacement> replacements;
  for (const File& file : files_) {
    if (file.path == stdout_path) continue;
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file.path, error);
    if (std::filesystem::is_directory(status)) return cannot_write(file.path, "it is a folder");
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
      if (Result<void> written = write_into(file.path, file.content); !written) return written;
      continue;
    }
    Result<FileReplacement> replacement = FileReplacement::write(file.path, file.content);
    if (!replacement) return replacement.error();
    replacements.push_back(std::move(*replacement));
  }
  for (FileReplacement& replacement : replacements) {
    if (Result<void> placed = replacement.take_place(); !placed) return placed;
  }
  for (const File& file : files_) {
    if (file.path == stdout_path) fmt::print("{}", file.content);
  }
  return {};
}

}  // namespace opentmcl::app
