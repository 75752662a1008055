#pragma once

#include <string>

#include "client/error.hpp"
#include "server/file_lock.hpp"

namespace opentmcl::server {

/// A symbolic link that gives a pseudo terminal a name that stays the same from run to run. Removed at the end, unless
/// somebody else has made it point elsewhere. A lock file beside it tells the link of a program that runs from one left
/// behind: the number of a terminal that is gone is soon that of another one.
class PtyLink {
 public:
  /// Makes `path` point to `terminal`. A link that was left over from a run that was killed, that leads nowhere, or to
  /// `terminal` already, gets replaced. Errors: input_output (the path is no link, another program has it, it leads to
  /// something else that exists, or the folder cannot be written).
  static client::Result<PtyLink> create(const std::string& path, const std::string& terminal);

  PtyLink(PtyLink&& other) noexcept;
  PtyLink& operator=(PtyLink&&) = delete;
  ~PtyLink();

  const std::string& path() const { return path_; }

 private:
  PtyLink(std::string path, std::string terminal, FileLock lock);

  std::string path_;  // empty when moved from
  std::string terminal_;
  FileLock lock_;
};

/// Where the link of a module goes when the user does not say: $XDG_RUNTIME_DIR/tmcl-pd1161, or in /tmp where there is
/// no such folder. @param module ModuleDescription::argument
std::string default_link_path(const std::string& module);

}  // namespace opentmcl::server
