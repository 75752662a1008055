#include "apps/tmcl/output_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

constexpr const char* stdout_path = "-";

Error cannot_write(const std::string& path, const std::string& reason) {
  return {ErrorKind::input_output, fmt::format("cannot write {}: {}", path, reason), {}};
}

/// `shown` is the path the user knows.
Result<void> write_to(const std::string& path, const std::string& content, const std::string& shown) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (file) return {};
  return cannot_write(shown, std::generic_category().message(errno));
}

/// A file that is written beside the one it is to replace.
struct Replacement {
  std::string temporary;
  std::filesystem::path target;
  std::string shown;
};

/// Removes the files that were not moved to their places.
class Replacements {
 public:
  Replacements() = default;
  ~Replacements() {
    std::error_code ignored;
    for (const Replacement& one : files_) std::filesystem::remove(one.temporary, ignored);
  }
  Replacements(const Replacements&) = delete;
  Replacements& operator=(const Replacements&) = delete;

  Result<void> prepare(const std::string& path, const std::string& content) {
    std::error_code error;
    // Where a link leads is replaced, not the link.
    std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
    if (error) target = path;
    const bool replaces = std::filesystem::exists(target, error);
    // Renaming would replace a file nobody may write, too.
    if (replaces && ::access(target.c_str(), W_OK) != 0) {
      return cannot_write(path, std::generic_category().message(errno));
    }
    std::string temporary = fmt::format("{}.{}.{}", target.string(), ::getpid(), files_.size());
    files_.push_back({std::move(temporary), std::move(target), path});
    if (Result<void> written = write_to(files_.back().temporary, content, path); !written) return written;
    if (replaces) {
      std::filesystem::permissions(files_.back().temporary, std::filesystem::status(files_.back().target).permissions(),
                                   error);
      if (error) return cannot_write(path, error.message());
    }
    return {};
  }

  Result<void> move_all() {
    for (; !files_.empty(); files_.pop_back()) {
      std::error_code error;
      const Replacement& one = files_.back();
      std::filesystem::rename(one.temporary, one.target, error);
      if (error) return cannot_write(one.shown, error.message());
    }
    return {};
  }

 private:
  std::vector<Replacement> files_;
};

}  // namespace

void OutputFiles::add(std::string path, std::string content) {
  files_.push_back({std::move(path), std::move(content)});
}

Result<void> OutputFiles::write() const {
  Replacements replacements;
  for (const File& file : files_) {
    if (file.path == stdout_path) continue;
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file.path, error);
    if (std::filesystem::is_directory(status)) return cannot_write(file.path, "it is a folder");
    const bool is_special = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    Result<void> written =
        is_special ? write_to(file.path, file.content, file.path) : replacements.prepare(file.path, file.content);
    if (!written) return written;
  }
  if (Result<void> moved = replacements.move_all(); !moved) return moved;
  for (const File& file : files_) {
    if (file.path == stdout_path) fmt::print("{}", file.content);
  }
  return {};
}

}  // namespace opentmcl::app
