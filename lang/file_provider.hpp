#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace opentmcl::lang {

struct FileContent {
  enum class State : std::uint8_t { found, missing, unreadable, too_large };

  State state = State::missing;
  std::string text;
};

/// Where included files come from; none is larger than `maximum_text_size`. Real: DiskFiles. For tests and editors,
/// whose buffers nobody has saved: MemoryFiles.
class FileProvider {
 public:
  virtual FileContent read(const std::string& path) = 0;

 protected:
  ~FileProvider() = default;
};

class DiskFiles final : public FileProvider {
 public:
  FileContent read(const std::string& path) override;
};

class MemoryFiles final : public FileProvider {
 public:
  void set(const std::string& path, std::string text) { texts_[path] = std::move(text); }

  FileContent read(const std::string& path) override;

 private:
  std::map<std::string, std::string> texts_;
};

}  // namespace opentmcl::lang
