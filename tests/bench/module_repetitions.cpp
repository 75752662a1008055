// Repeats a situation of a whole virtual module and ends: what module_instructions.py runs under callgrind.
//
//   module_repetitions SITUATION REPETITIONS
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <system_error>

#include "tests/bench/moving_module.hpp"

namespace opentmcl::bench {
namespace {

constexpr int exit_usage = 64;
constexpr int exit_other_situation = 70;

int usage() {
  std::fputs("usage: module_repetitions SITUATION REPETITIONS\n", stderr);
  return exit_usage;
}

int run(const Situation& situation, unsigned repetitions) {
  MovingModule bench;
  situation.begin(bench);
  for (unsigned repetition = 0; repetition < repetitions; ++repetition) situation.repeat(bench);
  if (situation.is_met(bench)) return 0;
  std::fputs("the module does something else\n", stderr);
  return exit_other_situation;
}

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return usage();
  const std::string_view name = arguments[1];
  const Situation* const situation = std::find_if(std::begin(measured_situations), std::end(measured_situations),
                                                  [name](const Situation& known) { return known.name == name; });
  unsigned repetitions = 0;
  const char* const text = arguments[2];
  const char* const text_end = text + std::strlen(text);
  const auto [end, error] = std::from_chars(text, text_end, repetitions);
  if (situation == std::end(measured_situations) || error != std::errc{} || end != text_end) return usage();
  return run(*situation, repetitions);
}

}  // namespace
}  // namespace opentmcl::bench

int main(int argument_count, char** arguments) {
  return opentmcl::bench::main(argument_count, arguments);
}
