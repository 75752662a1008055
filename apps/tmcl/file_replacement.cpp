#include "apps/tmcl/file_replacement.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// A file beside the one to be replaced; gone again unless it took that one's place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& target) : path_(target + ".XXXXXX"), descriptor_(mkstemp(path_.data())) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    if (!path_.empty()) unlink(path_.c_str());
  }

  // Each of these is true when it was done; else errno says why not.
  bool is_open() const { return descriptor_ >= 0; }
  bool write_all(std::string_view content) const {
    while (!content.empty()) {
      const ssize_t written = write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      content.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
  }
  bool take_permissions(const std::string& target) const {
    struct stat status {};
    return stat(target.c_str(), &status) == 0 && fchmod(descriptor_, status.st_mode & 07777U) == 0;
  }
  bool take_place_of(const std::string& target) {
    if (fsync(descriptor_) != 0 || std::rename(path_.c_str(), target.c_str()) != 0) return false;
    path_.clear();
    return true;
  }

 private:
  std::string path_;
  int descriptor_;
};

}  // namespace

Result<void> replace_file(const std::string& path, const std::string& content) {
  std::error_code error;
  const std::string target = std::filesystem::canonical(path, error).string();
  const auto failure = [&](int number) {
    return Error{
        ErrorKind::input_output, fmt::format("cannot write {}: {}", path, std::generic_category().message(number)), {}};
  };
  if (error) return failure(error.value());
  // Renaming would also replace a file nobody may write.
  if (access(target.c_str(), W_OK) != 0) return failure(errno);
  TemporaryFile file(target);
  const bool replaced =
      file.is_open() && file.write_all(content) && file.take_permissions(target) && file.take_place_of(target);
  return replaced ? Result<void>() : failure(errno);
}

}  // namespace opentmcl::app
