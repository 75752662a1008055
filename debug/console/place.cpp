#include "debug/console/place.hpp"

#include <string>

#include "debug/mistake.hpp"
#include "debug/typed_text.hpp"
#include "lang/diagnostic.hpp"
#include "lang/suggestion.hpp"

namespace opentmcl::debug {

using client::Result;

namespace {

Result<std::uint16_t> of_line(lang::FileId file, std::size_t line, const Program& program) {
  if (const auto address = program.address_of(file, line)) return *address;
  return mistake(program.file_name(file) + " has no instruction on line " + std::to_string(line) + " or below");
}

Result<std::uint16_t> of_label(std::string_view text, const Program& program) {
  const std::size_t plus = text.find('+');
  const std::string_view name = text.substr(0, plus);
  const auto label = program.address_of_label(name);
  if (!label) {
    lang::Suggestion suggestion(name);
    for (const lang::Label& known : program.labels()) suggestion.consider(known.name);
    const std::string hint = suggestion.text();
    return mistake("there is no label " + lang::in_quotes(name) + (hint.empty() ? "" : ": " + hint) +
                   "; a place is a line (12), FILE:LINE, a label (Loop, Loop+2) or an address (*7)");
  }
  if (plus == std::string_view::npos) return *label;
  const auto offset = number_in<std::size_t>(text.substr(plus + 1));
  if (!offset || *offset >= program.size() - *label) {
    return mistake(lang::in_quotes(text) + " is not in the program, which has " + std::to_string(program.size()) +
                   " instructions");
  }
  return static_cast<std::uint16_t>(*label + *offset);
}

}  // namespace

Result<std::uint16_t> address_of_place(std::string_view text, const Program& program, std::uint16_t here) {
  if (text.starts_with('*')) {
    const auto address = number_in<std::size_t>(text.substr(1));
    if (address && *address < program.module().program_capacity) return static_cast<std::uint16_t>(*address);
    return mistake("expected an address below " + std::to_string(program.module().program_capacity) + ", not " +
                   lang::in_quotes(text.substr(1)));
  }
  if (const auto line = number_in<std::size_t>(text)) {
    const auto current = program.line_of(here);
    return of_line(current ? current->file : 0, *line, program);
  }
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return of_label(text, program);
  const auto file = program.find_file(text.substr(0, colon));
  if (!file) return mistake("the program has no file " + lang::in_quotes(text.substr(0, colon)));
  const auto line = number_in<std::size_t>(text.substr(colon + 1));
  if (!line) return mistake("expected the number of a line, not " + lang::in_quotes(text.substr(colon + 1)));
  return of_line(*file, *line, program);
}

}  // namespace opentmcl::debug
