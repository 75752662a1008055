#include "apps/tmcl/trace_file.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

Result<std::unique_ptr<TraceFile>> TraceFile::create(const std::string& path) {
  std::ofstream file(path);
  if (!file) {
    return Error{ErrorKind::input_output, "cannot write " + path + ": " + std::generic_category().message(errno), {}};
  }
  return std::make_unique<TraceFile>(path, std::move(file));
}

void TraceFile::changed(twin::Tick tick, std::string_view signal, std::int64_t value) {
  file_ << twin::trace_line(tick, signal, value);
}

Result<void> TraceFile::finish() {
  file_.close();
  if (!file_) return Error{ErrorKind::input_output, "cannot write " + path_ + ": is the disk full?", {}};
  return {};
}

}  // namespace opentmcl::app
