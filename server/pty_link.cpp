#include "server/pty_link.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

namespace opentmcl::server {

namespace fs = std::filesystem;

namespace {

client::Error refused(const std::string& path, const std::string& why) {
  return {client::ErrorKind::input_output, "cannot make the link " + path + ": " + why, {}};
}

}  // namespace

client::Result<PtyLink> PtyLink::create(const std::string& path, const std::string& terminal) {
  std::error_code error;
  const bool was_left_behind = FileLock::is_present(path);
  client::Result<FileLock> lock = FileLock::acquire(path);
  if (!lock) {
    if (lock.error().kind != client::ErrorKind::bad_file) return lock.error();
    return refused(path, "it is in use by another virtual module; end that one or choose another path");
  }
  const fs::file_status status = fs::symlink_status(path, error);
  if (fs::exists(status)) {
    if (!fs::is_symlink(status)) return refused(path, "something that is not a link has this name");
    const std::string target = fs::read_symlink(path, error).string();
    if (!was_left_behind && target != terminal && fs::exists(path, error)) {
      return refused(path, "it leads to " + target + ", which is in use; end that program or choose another path");
    }
    fs::remove(path, error);
  }
  fs::create_symlink(terminal, path, error);
  if (error) return refused(path, error.message());
  return PtyLink(path, terminal, std::move(*lock));
}

PtyLink::PtyLink(std::string path, std::string terminal, FileLock lock)
    : path_(std::move(path)), terminal_(std::move(terminal)), lock_(std::move(lock)) {}

PtyLink::PtyLink(PtyLink&& other) noexcept
    : path_(std::exchange(other.path_, {})), terminal_(std::move(other.terminal_)), lock_(std::move(other.lock_)) {}

PtyLink::~PtyLink() {
  if (path_.empty()) return;
  std::error_code error;
  if (fs::read_symlink(path_, error) == terminal_) fs::remove(path_, error);
}

std::string default_link_path(const std::string& module) {
  const char* runtime_folder = std::getenv("XDG_RUNTIME_DIR");
  std::error_code error;
  const bool usable = runtime_folder != nullptr && fs::is_directory(runtime_folder, error);
  return (fs::path(usable ? runtime_folder : "/tmp") / ("tmcl-" + module)).string();
}

}  // namespace opentmcl::server
