#pragma once

#include <string>

#include "client/error.hpp"
#include "client/file_descriptor.hpp"

namespace opentmcl::server {

/// Keeps other programs that lock too away from a file, by a lock file "FILE.lock" beside it: the file itself is
/// replaced whenever it changes, and a lock would stay with the old one. Removed when released; a lock file that a
/// killed program left behind locks nothing.
class FileLock {
 public:
  /// Errors: bad_file (somebody else has it), input_output.
  static client::Result<FileLock> acquire(const std::string& path);
  /// Whether there is a lock file for `path`: of somebody who has the lock, or left behind by a killed program.
  static bool is_present(const std::string& path);

  FileLock(FileLock&& other) noexcept = default;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

 private:
  FileLock(std::string path, client::FileDescriptor file) : path_(std::move(path)), file_(std::move(file)) {}

  std::string path_;
  client::FileDescriptor file_;
};

}  // namespace opentmcl::server
