#pragma once

#include <string>
#include <vector>

#include "client/error.hpp"

namespace opentmcl::app {

/// The files a command makes: all of them or, if one cannot be written, none.
class OutputFiles {
 public:
  /// `path` "-" is stdout.
  void add(std::string path, std::string content);

  /// Writes each file beside its place first and moves all there then, so that nobody ever reads half a file. What is
  /// no regular file, /dev/null or a pipe, is written to as it is. Error: input_output.
  client::Result<void> write() const;

 private:
  struct File {
    std::string path;
    std::string content;
  };

  std::vector<File> files_;
};

}  // namespace opentmcl::app
