#include "lang/include_search.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "lang/diagnostic.hpp"
#include "lang/include_files.hpp"

namespace opentmcl::lang {

IncludeSearchResult search_include(std::string_view name, const std::string& including_file,
                                   const std::vector<std::string>& include_path, const ModuleDescription& module,
                                   FileProvider& files) {
  std::string portable_name(name);
  std::replace(portable_name.begin(), portable_name.end(), '\\', '/');

  std::vector<std::filesystem::path> folders{std::filesystem::path(including_file).parent_path()};
  folders.insert(folders.end(), include_path.begin(), include_path.end());
  std::string places;
  for (const std::filesystem::path& folder : folders) {
    std::string path = (folder / portable_name).lexically_normal().string();
    FileContent content = files.read(path);
    if (content.state != FileContent::State::missing) {
      return {content.state, std::move(path), std::move(content.text), {}};
    }
    if (!places.empty()) places += ", ";
    places += in_quotes(folder.empty() ? "." : folder.string());
  }

  std::optional<std::string> text = built_in_file(name, module);
  if (text) return {FileContent::State::found, std::string(name), std::move(*text), {}, true};
  return {FileContent::State::missing,
          {},
          {},
          "looked in " + places + " and among the built-in " + parameter_file_name + " and " + interrupt_file_name};
}

bool is_same_path(const std::string& left, const std::string& right) {
  return std::filesystem::path(left).lexically_normal() == std::filesystem::path(right).lexically_normal();
}

}  // namespace opentmcl::lang
