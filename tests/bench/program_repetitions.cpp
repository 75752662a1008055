// Takes a given number of turns of the main loop and ends: what program_instructions.py runs under callgrind.
//
//   program_repetitions running|idle TURNS      with a program that runs, and without
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>
#include <system_error>

#include "tests/bench/direct_mode_boards.hpp"
#include "tests/bench/program_loop.hpp"

namespace opentmcl::bench {
namespace {

constexpr int exit_usage = 64;
constexpr int exit_wrong_reply = 70;

int usage() {
  std::fputs("usage: program_repetitions running|idle TURNS\n", stderr);
  return exit_usage;
}

int run(std::string_view what, unsigned turns) {
  if (what != "running" && what != "idle") return usage();
  const auto board = std::make_unique<RegisterFileBoard>();
  start(*board);
  if (what == "running" && !run_program(*board)) {
    std::fputs("the program does not run\n", stderr);
    return exit_wrong_reply;
  }
  for (unsigned turn = 0; turn < turns; ++turn) board->module().poll(board->now());
  return 0;
}

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return usage();
  unsigned turns = 0;
  const char* const text = arguments[2];
  const char* const text_end = text + std::strlen(text);
  const auto [end, error] = std::from_chars(text, text_end, turns);
  if (error != std::errc{} || end != text_end) return usage();
  return run(arguments[1], turns);
}

}  // namespace
}  // namespace opentmcl::bench

int main(int argument_count, char** arguments) {
  return opentmcl::bench::main(argument_count, arguments);
}
