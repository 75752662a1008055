#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "client/error.hpp"
#include "server/session_event.hpp"
#include "server/session_setup.hpp"

namespace opentmcl::server {

/// Everything that comes to a module from outside, written to a file as it comes, so that it can happen again
/// (docs/session_log.md). A command of a host takes 40 to 70 bytes; what the module does by itself takes none.
class SessionLog {
 public:
  /// Of a log without a name: a million commands. It may lie in memory (a temporary folder often does).
  static constexpr std::uint64_t longest_nameless = 64 << 20;

  /// For the file `path`. Until publish() the log is beside it, under another name. Error: input_output.
  static client::Result<SessionLog> create(const std::string& path, const SessionSetup& setup);
  /// In a file that nobody sees and that is gone with the program; from longest_nameless bytes on it is given up.
  /// Error: input_output.
  static client::Result<SessionLog> create_nameless(const SessionSetup& setup);

  /// Replaces the file the log is for. Error: input_output.
  client::Result<void> publish();

  void write(const SessionEvent& event);
  /// So that whoever reads the file finds everything up to now.
  void flush();

  /// What is wrong with the log: it could not be written, or became too long. Later events are not in it.
  const std::optional<client::Error>& failure() const { return failure_; }

  /// Makes `path` a log of what is in this one and `end` after that. The file is replaced as a whole or left as it is.
  /// Error: input_output.
  client::Result<void> save(const std::string& path, const SessionEvent& end);

  static constexpr const char* magic = "OpenTMCL session log";
  static constexpr unsigned format_version = 1;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;

  SessionLog(File file, std::string path, const SessionSetup& setup);
  void write_line(const std::string& line);
  client::Result<void> copy_to(std::FILE* target);

  File file_;
  std::string path_;  // empty: nameless
  std::uint64_t length_ = 0;
  std::optional<client::Error> failure_;
};

}  // namespace opentmcl::server
