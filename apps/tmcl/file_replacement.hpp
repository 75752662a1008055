#pragma once

#include <string>

#include "client/error.hpp"

namespace opentmcl::app {

/// A new content for a file, written beside it first and put in its place in one step then: whoever reads the file sees
/// the old content or the new one, also when the program or the machine stops in between. Permissions stay; where a
/// symbolic link leads is replaced, not the link. Gone again if it never took the place.
class FileReplacement {
 public:
  /// The file need not exist yet. Error: input_output.
  static client::Result<FileReplacement> write(const std::string& path, const std::string& content);

  FileReplacement(FileReplacement&& other) noexcept;
  FileReplacement& operator=(FileReplacement&&) = delete;
  ~FileReplacement();

  /// Error: input_output, with the old content still there.
  client::Result<void> take_place();

 private:
  FileReplacement(std::string path, std::string target);

  std::string path_;       ///< as the user knows it
  std::string target_;     ///< where it leads
  std::string temporary_;  ///< empty: there is none any more
};

}  // namespace opentmcl::app
