#include "lang/listing.hpp"

#include <cstddef>
#include <vector>

#include "lang/hexadecimal.hpp"

namespace opentmcl::lang {
namespace {

std::string right_aligned(std::size_t number, std::size_t width) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < width ? width - digits.size() : 0, ' ') + digits;
}

constexpr std::size_t address_width = 6;
constexpr std::size_t line_number_width = 6;

std::string code_columns(const Program& program, std::size_t address) {
  return right_aligned(address, address_width) + "  " + hexadecimal(program.commands[address]);
}

/// As wide as `code_columns`: seven bytes of two digits with blanks between them.
std::string without_code() {
  std::string blanks(address_width + 2 + 7 * 3 - 1, ' ');
  return blanks;
}

/// Addresses of the instructions of a file in the order of their places in it; included files lie between them.
std::vector<std::size_t> addresses_in(const Program& program, FileId file) {
  std::vector<std::size_t> addresses;
  for (std::size_t i = 0; i < program.commands.size(); ++i) {
    if (program.source_map[i].file == file && program.source_map[i].length != 0) addresses.push_back(i);
  }
  return addresses;
}

void list_file(std::string& text, const Program& program, const SourceFile& source,
               const std::vector<std::size_t>& addresses) {
  const LineIndex lines(source.text);
  text += source.name + "\n";
  auto next = addresses.begin();
  for (std::size_t line = 1; line <= lines.line_count(); ++line) {
    const std::size_t end = line < lines.line_count() ? lines.start_of(line + 1) : source.text.size();
    const bool has_code = next != addresses.end() && program.source_map[*next].offset < end;
    text += has_code ? code_columns(program, *next++) : without_code();
    text += "  " + right_aligned(line, line_number_width) + "  " + to_utf8(lines.line(line)) + "\n";
  }
}

}  // namespace

std::string listing(const Program& program, const Sources& sources) {
  std::string text;
  for (FileId file = 0; file < sources.size(); ++file) {
    const std::vector<std::size_t> addresses = addresses_in(program, file);
    if (file == 0 || !addresses.empty()) list_file(text, program, sources[file], addresses);
  }
  const bool stop_appended = !program.commands.empty() && program.source_map.back().length == 0;
  if (stop_appended) text += code_columns(program, program.commands.size() - 1) + "  (STOP appended)\n";
  return text;
}

}  // namespace opentmcl::lang
