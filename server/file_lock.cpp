#include "server/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace opentmcl::server {

namespace {

std::string lock_path_of(const std::string& path) {
  return path + ".lock";
}

/// False when `path` was removed, or made anew, between our opening and our locking it.
bool is_still(const std::string& path, int file) {
  struct stat ours {};
  struct stat named {};
  return ::fstat(file, &ours) == 0 && ::stat(path.c_str(), &named) == 0 && ours.st_ino == named.st_ino &&
         ours.st_dev == named.st_dev;
}

}  // namespace

client::Result<FileLock> FileLock::acquire(const std::string& path) {
  const std::string lock_path = lock_path_of(path);
  while (true) {
    client::FileDescriptor file(::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    if (!file.is_open()) {
      return client::Error{client::ErrorKind::input_output,
                           "cannot make " + lock_path + ": " + std::generic_category().message(errno),
                           {}};
    }
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
      return client::Error{client::ErrorKind::bad_file, path + " is in use by another virtual module", {}};
    }
    if (is_still(lock_path, file.get())) return FileLock(lock_path, std::move(file));
  }
}

bool FileLock::is_present(const std::string& path) {
  return ::access(lock_path_of(path).c_str(), F_OK) == 0;
}

FileLock::~FileLock() {
  // Removed while still locked, so that nobody can have got hold of this very file.
  if (file_.is_open()) ::unlink(path_.c_str());
}

}  // namespace opentmcl::server
