// The EEPROM of a virtual module in a file, so that it survives the program. The format is in docs/eeprom.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "firmware/spec/modules.hpp"
#include "twin/chip/eeprom.hpp"

namespace opentmcl {

struct EepromFileError {
  enum class Kind : std::uint8_t {
    bad_content,  ///< not an EEPROM file, one of another module, or a damaged one
    input_output  ///< the operating system refused an operation
  };

  Kind kind;
  std::string message;  ///< one line that names the file
};

class EepromFile {
 public:
  using Image = twin::Eeprom::Image;

  EepromFile(std::string path, const ModuleDescription& module) : path_(std::move(path)), module_(module) {}

  const std::string& path() const { return path_; }

  /// Puts the file's content into `eeprom`; a file that does not exist is made from what is in it. Refuses a file that
  /// is not exactly as save() writes it, and leaves it as it is.
  std::optional<EepromFileError> load(twin::Eeprom& eeprom);

  /// Replaces the file if the EEPROM has been written to since the last load() or save(). Whoever reads the file at any
  /// time finds the old content or the new one. The file's permissions stay.
  std::optional<EepromFileError> save(const twin::Eeprom& eeprom);

  /// The EEPROM is another one from now on: the next save() replaces the file.
  void note_exchange() { saved_bytes_.reset(); }

  /// The whole content of a file.
  static std::string encode(const Image& image, const ModuleDescription& module);

  /// The reason why `content` is not an EEPROM file of `module`, or nothing and the image.
  static std::optional<std::string> decode(std::string_view content, const ModuleDescription& module, Image& image);

 private:
  std::optional<EepromFileError> write(const twin::Eeprom& eeprom);

  std::string path_;
  const ModuleDescription& module_;
  std::optional<std::uint64_t> saved_bytes_;  // Eeprom::bytes_written() at the last load or save
};

}  // namespace opentmcl
