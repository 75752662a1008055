#include "server/session_log.hpp"

#include <array>
#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

namespace opentmcl::server {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

Error cannot(const std::string& what, int error) {
  return {ErrorKind::input_output, "cannot " + what + ": " + std::generic_category().message(error), {}};
}

/// A file is written under this name first and then renamed, so that its own always stands for a whole one.
std::string name_beside(const std::string& path) {
  return path + ".new";
}

std::string text_of_path(const std::string& path) {
  return path.empty() ? "the session's log in the temporary folder" : path;
}

}  // namespace

Result<SessionLog> SessionLog::create(const std::string& path, const SessionSetup& setup) {
  File file(std::fopen(name_beside(path).c_str(), "w+"));
  if (!file) return cannot("write " + name_beside(path), errno);
  SessionLog log(std::move(file), path, setup);
  if (log.failure_) return *log.failure_;
  return log;
}

Result<SessionLog> SessionLog::create_nameless(const SessionSetup& setup) {
  File file(std::tmpfile());
  if (!file) return cannot("make a file in the temporary folder", errno);
  SessionLog log(std::move(file), {}, setup);
  if (log.failure_) return *log.failure_;
  return log;
}

SessionLog::SessionLog(File file, std::string path, const SessionSetup& setup)
    : file_(std::move(file)), path_(std::move(path)) {
  write_line(magic);
  write_line("format " + std::to_string(format_version));
  constexpr bool is_ascii = true;
  // The name of a scenario's file may be no UTF-8.
  constexpr auto instead_of_what_is_no_text = nlohmann::ordered_json::error_handler_t::replace;
  write_line("setup " + to_json(setup).dump(-1, ' ', is_ascii, instead_of_what_is_no_text));
  flush();
}

Result<void> SessionLog::publish() {
  if (path_.empty()) return {};
  std::error_code error;
  std::filesystem::rename(name_beside(path_), path_, error);
  if (error) return Error{ErrorKind::input_output, "cannot replace " + path_ + ": " + error.message(), {}};
  return {};
}

void SessionLog::write(const SessionEvent& event) {
  write_line(text_of(event));
}

void SessionLog::write_line(const std::string& line) {
  if (failure_) return;
  length_ += line.size() + 1;
  if (path_.empty() && length_ > longest_nameless) {
    failure_ = Error{ErrorKind::input_output,
                     "so much has happened that the session is no longer logged; start with --log FILE to log more",
                     {}};
    return;
  }
  if (std::fputs(line.c_str(), file_.get()) == EOF || std::fputc('\n', file_.get()) == EOF) {
    failure_ = cannot("write " + text_of_path(path_), errno);
  }
}

void SessionLog::flush() {
  if (!failure_ && std::fflush(file_.get()) != 0) failure_ = cannot("write " + text_of_path(path_), errno);
}

Result<void> SessionLog::save(const std::string& path, const SessionEvent& end) {
  flush();
  if (failure_) return *failure_;
  const std::string temporary = name_beside(path);
  File target(std::fopen(temporary.c_str(), "w"));
  if (!target) return cannot("write " + temporary, errno);
  Result<void> copied = copy_to(target.get());
  if (copied && (std::fputs((text_of(end) + '\n').c_str(), target.get()) == EOF))
    copied = cannot("write " + path, errno);
  if (std::fclose(target.release()) != 0 && copied) copied = cannot("write " + path, errno);
  std::error_code error;
  if (copied) {
    std::filesystem::rename(temporary, path, error);
    if (!error) return {};
    copied = Error{ErrorKind::input_output, "cannot replace " + path + ": " + error.message(), {}};
  }
  std::filesystem::remove(temporary, error);
  return copied;
}

Result<void> SessionLog::copy_to(std::FILE* target) {
  Result<void> outcome;
  std::array<char, 65536> block{};
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) return cannot("read " + text_of_path(path_), errno);
  while (outcome) {
    const std::size_t count = std::fread(block.data(), 1, block.size(), file_.get());
    if (count == 0) break;
    if (std::fwrite(block.data(), 1, count, target) != count) outcome = cannot("copy the session's log", errno);
  }
  if (std::ferror(file_.get()) != 0) outcome = cannot("read " + text_of_path(path_), EIO);
  if (std::fseek(file_.get(), 0, SEEK_END) != 0) failure_ = cannot("write " + text_of_path(path_), errno);
  return outcome;
}

}  // namespace opentmcl::server
