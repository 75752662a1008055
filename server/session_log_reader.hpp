#pragma once

#include <cstddef>
#include <fstream>
#include <optional>
#include <string>

#include "client/error.hpp"
#include "server/session_event.hpp"
#include "server/session_setup.hpp"

namespace opentmcl::server {

/// Reads what SessionLog has written, event by event.
class SessionLogReader {
 public:
  /// Errors: input_output, bad_file (no log, or of another version).
  static client::Result<SessionLogReader> open(const std::string& path);

  const std::string& path() const { return path_; }
  const SessionSetup& setup() const { return setup_; }

  /// The event to come; nothing at the end of the log, or where it is damaged.
  const std::optional<SessionEvent>& next() const { return next_; }
  void take();
  /// Of next(); the last one at the end.
  std::size_t line() const { return line_; }

  /// Why there is no next event, if the log has more. bad_file.
  const std::optional<client::Error>& failure() const { return failure_; }

  /// "my.log:17: " and `what`, about the event to come.
  client::Error error_here(const std::string& what) const;

 private:
  SessionLogReader(std::string path, std::ifstream file) : path_(std::move(path)), file_(std::move(file)) {}

  std::optional<client::Error> read_head();
  /// Without what follows the last line's end: whoever wrote that was interrupted.
  std::optional<std::string> read_line();

  std::string path_;
  std::ifstream file_;
  SessionSetup setup_;
  std::size_t line_ = 0;
  Microseconds time_ = 0;
  std::optional<SessionEvent> next_;
  std::optional<client::Error> failure_;
};

}  // namespace opentmcl::server
