// Sends commands of the mix a given number of times and ends: what direct_mode_instructions.py runs under callgrind.
//
//   direct_mode_repetitions list                                    names of the commands, one a line
//   direct_mode_repetitions FEED CHIPS COMMAND REPETITIONS          COMMAND: index in that list, or "mix"
#include <charconv>
#include <cstdio>
#include <memory>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "tests/bench/direct_mode_feeds.hpp"

namespace opentmcl::bench {
namespace {

constexpr int exit_usage = 64;
constexpr int exit_wrong_reply = 70;

struct Range {
  std::size_t begin;
  std::size_t end;
};

struct Job {
  std::string_view feed;
  std::string_view chips;
  Range commands;
  unsigned repetitions;
};

template <class Number>
bool parse(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

template <class Feed, class Board>
int repeat(const Job& job) {
  const auto board = std::make_unique<Board>();
  const MixRequests requests;
  if constexpr (!std::is_same_v<Board, EmptyBoard>) {
    if (const MixedCommand* wrong = warm_up<Feed>(*board, requests)) {
      std::fprintf(stderr, "%s is not answered as expected\n", wrong->name);
      return exit_wrong_reply;
    }
  }
  for (unsigned n = 0; n < job.repetitions; ++n) {
    for (std::size_t i = job.commands.begin; i < job.commands.end; ++i) Feed::exchange(*board, requests[i]);
  }
  return 0;
}

int usage() {
  std::fputs("usage: direct_mode_repetitions list | handle|whole|bytes registers|models|none INDEX|mix REPETITIONS\n",
             stderr);
  return exit_usage;
}

template <class Feed>
int repeat_on(const Job& job) {
  if (job.chips == "registers") return repeat<Feed, RegisterFileBoard>(job);
  if (job.chips == "models") return repeat<Feed, ModelBoard>(job);
  if (job.chips == "none") return repeat<Feed, EmptyBoard>(job);
  return usage();
}

int run(const Job& job) {
  if (job.feed == "handle") return repeat_on<Handle>(job);
  if (job.feed == "whole") return repeat_on<WholeDatagram>(job);
  if (job.feed == "bytes") return repeat_on<ByteByByte>(job);
  return usage();
}

int main(int argument_count, char** arguments) {
  if (argument_count == 2 && std::string_view(arguments[1]) == "list") {
    for (const MixedCommand& row : direct_mode_mix) std::puts(row.name);
    return 0;
  }
  if (argument_count != 5) return usage();
  Job job{arguments[1], arguments[2], {0, direct_mode_mix_size}, 0};
  if (std::string_view(arguments[3]) != "mix") {
    if (!parse(arguments[3], job.commands.begin) || job.commands.begin >= direct_mode_mix_size) return usage();
    job.commands.end = job.commands.begin + 1;
  }
  if (!parse(arguments[4], job.repetitions)) return usage();
  return run(job);
}

}  // namespace
}  // namespace opentmcl::bench

int main(int argument_count, char** arguments) {
  return opentmcl::bench::main(argument_count, arguments);
}
