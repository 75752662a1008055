#include "debug/console/listing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lang/source.hpp"

namespace opentmcl::debug {

namespace {

constexpr const char* bold = "\033[1m";
constexpr const char* dim = "\033[2m";
constexpr const char* green = "\033[32m";
constexpr const char* red = "\033[31m";
constexpr const char* plain = "\033[0m";

/// A source can hold anything; a terminal is to get no control characters of it.
std::string printable(std::string_view line) {
  std::string text = lang::to_utf8(line);
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c != '\t' && (byte < 0x20 || byte == 0x7F)) c = '?';
  }
  return text;
}

}  // namespace

std::string Listing::coloured(const char* sequence, const std::string& text) const {
  return colours_ ? sequence + text + plain : text;
}

std::string Listing::emphasised(const std::string& text) const {
  return coloured(bold, text);
}

std::string Listing::faint(const std::string& text) const {
  return coloured(dim, text);
}

std::string Listing::place(std::uint16_t address) const {
  const auto line = program_.line_of(address);
  const bool has_label = !program_.place_of(address).label.empty();
  std::string text = (has_label ? "" : "address ") + program_.name_of(address);
  if (line) text += fmt::format(", {}:{}", program_.file_name(line->file), line->line);
  return text;
}

std::string Listing::marked(bool is_here, bool has_breakpoint, const std::string& number,
                            const std::string& text) const {
  const std::string arrow = is_here ? coloured(green, "=>") : "  ";
  const std::string dot = has_breakpoint ? coloured(red, "*") : " ";
  return fmt::format("{}{}{} {}", dot, arrow, faint(fmt::format("{:>5}", number)), is_here ? emphasised(text) : text);
}

std::string Listing::current_line(std::uint16_t address, const Command& command) const {
  constexpr bool is_here = true;
  const auto line = program_.line_of(address);
  if (!line) return marked(is_here, false, fmt::format("*{}", address), "    " + program_.text_of(command));
  return marked(is_here, false, std::to_string(line->line), printable(program_.line_text(line->file, line->line)));
}

std::vector<std::string> Listing::lines(std::uint16_t address, std::size_t before, std::size_t count,
                                        std::uint16_t here,
                                        const std::function<bool(std::uint16_t)>& has_breakpoint) const {
  std::vector<std::string> listed;
  const auto middle = program_.line_of(address);
  if (!middle) return listed;
  const std::size_t first = middle->line > before ? middle->line - before : 1;
  const std::size_t end = std::min(first + count, program_.line_count(middle->file) + 1);
  const auto present = program_.line_of(here);
  for (std::size_t line = first; line < end; ++line) {
    const bool is_here = present && present->file == middle->file && present->line == line;
    const auto on_line = program_.address_of(middle->file, line);
    const bool is_of_line = on_line && program_.line_of(*on_line)->line == line;
    listed.push_back(marked(is_here, is_of_line && has_breakpoint(*on_line), std::to_string(line),
                            printable(program_.line_text(middle->file, line))));
  }
  return listed;
}

}  // namespace opentmcl::debug
