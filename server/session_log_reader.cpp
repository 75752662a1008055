#include "server/session_log_reader.hpp"

#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "server/session_log.hpp"

namespace opentmcl::server {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

/// Of a line that is wrong.
constexpr std::size_t longest_quotation = 80;

}  // namespace

Result<SessionLogReader> SessionLogReader::open(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    return Error{ErrorKind::input_output, "cannot read " + path + ": " + std::generic_category().message(errno), {}};
  }
  SessionLogReader reader(path, std::move(file));
  if (std::optional<Error> error = reader.read_head()) return *error;
  reader.take();
  return reader;
}

std::optional<Error> SessionLogReader::read_head() {
  const std::string expected_format = "format " + std::to_string(SessionLog::format_version);
  const std::string setup_key = "setup ";
  if (read_line() != SessionLog::magic) return error_here("it is not a session log of OpenTMCL");
  const std::optional<std::string> format = read_line();
  if (format != expected_format) {
    return error_here("expected " + expected_format + ", found " + format.value_or("nothing"));
  }
  const std::optional<std::string> setup = read_line();
  if (!setup || setup->compare(0, setup_key.size(), setup_key) != 0) return error_here("expected the session's setup");
  constexpr bool with_exceptions = false;
  const nlohmann::json json = nlohmann::json::parse(setup->substr(setup_key.size()), nullptr, with_exceptions);
  Result<SessionSetup> read = session_setup_from(json);
  if (!read) return error_here(read.error().message);
  setup_ = std::move(*read);
  return std::nullopt;
}

std::optional<std::string> SessionLogReader::read_line() {
  std::string line;
  ++line_;
  if (!std::getline(file_, line) || file_.eof()) return std::nullopt;
  return line;
}

void SessionLogReader::take() {
  next_.reset();
  if (failure_) return;
  const std::optional<std::string> line = read_line();
  if (!line) return;
  std::optional<SessionEvent> event = session_event_from(*line);
  if (!event) {
    failure_ = error_here("no event of a session: " + line->substr(0, longest_quotation));
  } else if (event->time < time_) {
    failure_ = error_here("the event is earlier than the one before");
  } else {
    time_ = event->time;
    next_ = std::move(event);
  }
}

Error SessionLogReader::error_here(const std::string& what) const {
  return {ErrorKind::bad_file, path_ + ":" + std::to_string(line_) + ": " + what, {}};
}

}  // namespace opentmcl::server
