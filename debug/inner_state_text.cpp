#include "debug/inner_state_text.hpp"

#include "firmware/spec/instructions.hpp"
#include "firmware/spec/interrupts.hpp"

namespace opentmcl::debug {

const char* name_of(Comparison comparison) {
  switch (comparison) {
    case Comparison::lower:
      return "lower";
    case Comparison::equal:
      return "equal or zero";
    case Comparison::greater:
      return "greater";
  }
  return "";
}

std::string names_of_error_flags(std::uint8_t flags) {
  std::string names;
  for (const Keyword& word : error_flag_words) {
    if (word.value == 0 || (flags >> (word.value - 1) & 1) == 0) continue;
    names.append(names.empty() ? "" : " ").append(word.word);
  }
  return names.empty() ? "none" : names;
}

std::string names_of_interrupts(const std::vector<std::uint8_t>& numbers) {
  std::string names;
  for (const std::uint8_t number : numbers) {
    for (const InterruptSpec& row : interrupts) {
      if (static_cast<std::uint8_t>(row.number) != number) continue;
      names.append(names.empty() ? "" : ", ")
          .append(row.symbol)
          .append(" (")
          .append(std::to_string(number))
          .append(")");
    }
  }
  return names.empty() ? "none" : names;
}

}  // namespace opentmcl::debug
