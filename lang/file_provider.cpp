#include "lang/file_provider.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "lang/source.hpp"

namespace opentmcl::lang {
namespace {

constexpr std::size_t first_piece = 65536;

}  // namespace

FileContent DiskFiles::read(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return {FileContent::State::missing, {}};
  if (std::filesystem::is_directory(status)) return {FileContent::State::unreadable, {}};
  const bool is_regular = std::filesystem::is_regular_file(status);
  const std::uintmax_t size = is_regular ? std::filesystem::file_size(path, error) : 0;
  if (error) return {FileContent::State::unreadable, {}};
  if (size > maximum_text_size) return {FileContent::State::too_large, {}};

  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) return {FileContent::State::unreadable, {}};
  std::string text;
  // The size is a guess: a file may grow meanwhile, and devices and pipes do not know theirs.
  std::size_t next = is_regular ? static_cast<std::size_t>(size) + 1 : first_piece;
  while (file) {
    const std::size_t filled = text.size();
    text.resize(filled + next);
    file.read(text.data() + filled, static_cast<std::streamsize>(next));
    text.resize(filled + static_cast<std::size_t>(file.gcount()));
    if (text.size() > maximum_text_size) return {FileContent::State::too_large, {}};
    next = std::max(first_piece, text.size());
  }
  if (file.bad()) return {FileContent::State::unreadable, {}};
  return {FileContent::State::found, std::move(text)};
}

FileContent MemoryFiles::read(const std::string& path) {
  const auto found = texts_.find(path);
  if (found == texts_.end()) return {FileContent::State::missing, {}};
  return {FileContent::State::found, found->second};
}

}  // namespace opentmcl::lang
