#include "boards/twin/eeprom_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "boards/twin/crc32.hpp"

namespace opentmcl {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view magic = "OpenTMCL EEPROM image";
constexpr unsigned format_version = 1;

/// Longer than any EEPROM file: what is longer need not be read to be refused.
constexpr std::uintmax_t longest_file = 2 * twin::Eeprom::size;

std::string header_line(std::string_view name, std::string_view value) {
  return std::string(name) + ": " + std::string(value) + "\n";
}

std::string crc_text(const EepromFile::Image& image) {
  char digits[9];
  std::snprintf(digits, sizeof digits, "%08X", crc32(image));
  return digits;
}

/// Takes `name: value` and the line's end off the front of `content`.
std::optional<std::string_view> take_value(std::string_view& content, std::string_view name) {
  const std::size_t end = content.find('\n');
  if (end == std::string_view::npos || end < name.size() + 2) return std::nullopt;
  const std::string_view line = content.substr(0, end);
  if (line.substr(0, name.size()) != name || line.substr(name.size(), 2) != ": ") return std::nullopt;
  content.remove_prefix(end + 1);
  return line.substr(name.size() + 2);
}

EepromFileError cannot(const char* what, const std::string& path, const std::string& why) {
  return {EepromFileError::Kind::input_output, std::string("cannot ") + what + " " + path + ": " + why};
}

}  // namespace

std::string EepromFile::encode(const Image& image, const ModuleDescription& module) {
  std::string content(magic);
  content += '\n';
  content += header_line("format", std::to_string(format_version));
  content += header_line("module", std::to_string(module.type_number));
  content += header_line("length", std::to_string(image.size()));
  content += header_line("crc-32", crc_text(image));
  content += '\n';
  content.append(image.begin(), image.end());
  return content;
}

std::optional<std::string> EepromFile::decode(std::string_view content, const ModuleDescription& module, Image& image) {
  if (content.substr(0, magic.size()) != magic || content.substr(magic.size(), 1) != "\n") {
    return "it is not an OpenTMCL EEPROM file";
  }
  content.remove_prefix(magic.size() + 1);
  const auto format = take_value(content, "format");
  if (!format) return "it is truncated or damaged";
  if (*format != std::to_string(format_version)) {
    return "it has format " + std::string(*format) + ", expected " + std::to_string(format_version);
  }
  const auto type = take_value(content, "module");
  const auto length = take_value(content, "length");
  const auto crc = take_value(content, "crc-32");
  if (!type || !length || !crc || content.substr(0, 1) != "\n") return "it is truncated or damaged";
  content.remove_prefix(1);
  if (*type != std::to_string(module.type_number)) {
    return "it belongs to a module of type " + std::string(*type) + ", not to a " + module.name;
  }
  if (*length != std::to_string(image.size())) {
    return "it is of an EEPROM of " + std::string(*length) + " bytes, expected " + std::to_string(image.size());
  }
  if (content.size() < image.size()) {
    return "it is truncated: " + std::to_string(content.size()) + " of " + std::to_string(image.size()) +
           " bytes of content";
  }
  if (content.size() > image.size()) {
    return "it has " + std::to_string(content.size() - image.size()) + " bytes too many";
  }
  std::copy(content.begin(), content.end(), image.begin());
  if (*crc != crc_text(image)) return "it is damaged: the checksum does not fit";
  return std::nullopt;
}

std::optional<EepromFileError> EepromFile::load(twin::Eeprom& eeprom) {
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (status.type() == fs::file_type::not_found) return write(eeprom);
  if (!fs::is_regular_file(status)) {
    return cannot("use", path_, fs::exists(status) ? "it is not a regular file" : error.message());
  }
  std::ifstream file(path_, std::ios::binary);
  if (!file) return cannot("read", path_, "no permission");
  if (fs::file_size(path_, error) > longest_file) {
    return EepromFileError{EepromFileError::Kind::bad_content,
                           path_ + " is refused: it is not an OpenTMCL EEPROM file"};
  }
  const std::string content{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) return cannot("read", path_, "the medium reports an error");
  Image image{};
  if (const std::optional<std::string> reason = decode(content, module_, image)) {
    return EepromFileError{EepromFileError::Kind::bad_content, path_ + " is refused: " + *reason};
  }
  eeprom.load(image);
  saved_bytes_ = eeprom.bytes_written();
  return std::nullopt;
}

std::optional<EepromFileError> EepromFile::save(const twin::Eeprom& eeprom) {
  if (eeprom.bytes_written() == saved_bytes_) return std::nullopt;
  return write(eeprom);
}

std::optional<EepromFileError> EepromFile::write(const twin::Eeprom& eeprom) {
  // Written beside the file and renamed: the name always stands for a whole image. A link is followed, so that the
  // file it leads to is the one replaced.
  std::error_code error;
  const fs::path target = fs::is_symlink(path_, error) ? fs::weakly_canonical(path_, error) : fs::path(path_);
  const fs::path temporary = target.string() + ".new";
  const fs::file_status status = fs::status(target, error);
  {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    if (!file) return cannot("write", path_, "no permission for " + temporary.string() + ", or no such folder");
    if (fs::exists(status)) fs::permissions(temporary, status.permissions(), error);
    const std::string content = encode(eeprom.image(), module_);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) {
      fs::remove(temporary, error);
      return cannot("write", path_, "is the disk full?");
    }
  }
  fs::rename(temporary, target, error);
  if (error) {
    const std::string why = error.message();
    fs::remove(temporary, error);
    return cannot("replace", path_, why);
  }
  saved_bytes_ = eeprom.bytes_written();
  return std::nullopt;
}

}  // namespace opentmcl
