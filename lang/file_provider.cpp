#include "lang/file_provider.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace opentmcl::lang {

FileContent DiskFiles::read(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return {FileContent::State::missing, {}};
  if (std::filesystem::is_directory(status)) return {FileContent::State::unreadable, {}};
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file.is_open() || file.bad()) return {FileContent::State::unreadable, {}};
  return {FileContent::State::found, std::move(text)};
}

FileContent MemoryFiles::read(const std::string& path) {
  const auto found = texts_.find(path);
  if (found == texts_.end()) return {FileContent::State::missing, {}};
  return {FileContent::State::found, found->second};
}

}  // namespace opentmcl::lang
