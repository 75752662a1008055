#include "apps/tmcl/file_replacement.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

Error cannot_write(const std::string& path, int number) {
  return {
      ErrorKind::input_output, fmt::format("cannot write {}: {}", path, std::generic_category().message(number)), {}};
}

/// A file nobody had before, beside `target`.
class NewFile {
 public:
  explicit NewFile(const std::string& target) {
    constexpr int others_there = 100;  // that ended programs with the same number have left
    constexpr mode_t as_the_user_wants = 0666;
    for (int i = 0; i < others_there && descriptor_ < 0; ++i) {
      path_ = fmt::format("{}.{}.{}", target, ::getpid(), i);
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, as_the_user_wants);
      if (descriptor_ < 0 && errno != EEXIST) return;
    }
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  const std::string& path() const { return path_; }

  // Each of these is true when it was done; else errno says why not.
  bool is_open() const { return descriptor_ >= 0; }
  bool write_all(std::string_view content) const {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      content.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }
  bool take_permissions(const struct stat& of) const { return ::fchmod(descriptor_, of.st_mode & 07777U) == 0; }
  bool reach_the_disk() const { return ::fsync(descriptor_) == 0; }

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace

FileReplacement::FileReplacement(std::string path, std::string target)
    : path_(std::move(path)), target_(std::move(target)) {}

FileReplacement::FileReplacement(FileReplacement&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})) {}

FileReplacement::~FileReplacement() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<FileReplacement> FileReplacement::write(const std::string& path, const std::string& content) {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
  FileReplacement replacement(path, error ? path : target.string());
  struct stat old {};
  const bool exists = ::stat(replacement.target_.c_str(), &old) == 0;
  // Renaming would also replace a file nobody may write.
  if (exists && ::access(replacement.target_.c_str(), W_OK) != 0) return cannot_write(path, errno);
  const NewFile file(replacement.target_);
  if (!file.is_open()) return cannot_write(path, errno);
  replacement.temporary_ = file.path();
  const bool written = file.write_all(content) && (!exists || file.take_permissions(old)) && file.reach_the_disk();
  if (!written) return cannot_write(path, errno);
  return replacement;
}

Result<void> FileReplacement::take_place() {
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) return cannot_write(path_, errno);
  temporary_.clear();
  return {};
}

}  // namespace opentmcl::app
