#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::lang {

struct IncludeSearchResult {
  FileContent::State state = FileContent::State::missing;
  std::string path;  ///< of the file found or unreadable
  std::string text;
  std::string note;  ///< where a missing file was looked for
  bool is_built_in = false;
};

/// Finds the file a source includes: in the folder of the including file, then in the folders of `include_path`, then
/// among the built-in files. A backslash in `name` separates folders, as where TMCL-IDE runs.
IncludeSearchResult search_include(std::string_view name, const std::string& including_file,
                                   const std::vector<std::string>& include_path, const ModuleDescription& module,
                                   FileProvider& files);

/// Whether two paths name the same file, as far as their text tells.
bool is_same_path(const std::string& left, const std::string& right);

}  // namespace opentmcl::lang
