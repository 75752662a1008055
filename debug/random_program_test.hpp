// For properties: programs that are different for each seed.
#pragma once

#include <rapidcheck.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace opentmcl::debug {

inline std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

/// A program that never ends, of instructions that calculate, call and jump: what they come to does not depend on the
/// time. @param others lines that may stand among them
inline std::string random_program(const std::vector<std::string>& others = {}) {
  std::string text = "Begin:\n";
  const auto count = *rc::gen::inRange(1, 15);
  for (int i = 0; i < count; ++i) {
    const std::string number = std::to_string(*rc::gen::inRange(-50, 50));
    const std::string variable = std::to_string(*rc::gen::inRange(0, 6));
    const std::string label = "L" + std::to_string(i);
    std::vector<std::string> choices = {joined({"CALC ADD, ", number}),
                                        joined({"CALC XOR, ", number}),
                                        "CALCX SWAP",
                                        joined({"SGP ", variable, ", 2, ", number}),
                                        joined({"GGP ", variable, ", 2"}),
                                        joined({"AGP ", variable, ", 2"}),
                                        "CSUB Sub",
                                        joined({"COMP ", number, "\nJC GT, ", label, "\nCALC MUL, 3\n", label, ":"})};
    choices.insert(choices.end(), others.begin(), others.end());
    text += *rc::gen::elementOf(choices) + "\n";
  }
  return text + "JA Begin\nSub: CALC ADD, 1\nCSUB Inner\nRSUB\nInner: CALC MUL, 2\nRSUB\n";
}

}  // namespace opentmcl::debug
