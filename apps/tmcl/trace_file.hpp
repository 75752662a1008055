#pragma once

#include <fstream>
#include <memory>
#include <string>

#include "client/error.hpp"
#include "twin/world/trace.hpp"

namespace opentmcl::app {

/// Writes every signal of a world to a file, as twin::TraceText does.
class TraceFile final : public twin::TraceObserver {
 public:
  /// Error: input_output.
  static client::Result<std::unique_ptr<TraceFile>> create(const std::string& path);

  TraceFile(std::string path, std::ofstream file) : path_(std::move(path)), file_(std::move(file)) {}

  void changed(twin::Tick tick, std::string_view signal, std::int64_t value) override;

  /// Error: input_output, now or at any time before.
  client::Result<void> finish();

 private:
  std::string path_;
  std::ofstream file_;
};

}  // namespace opentmcl::app
