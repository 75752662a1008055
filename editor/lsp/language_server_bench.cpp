// How long after a keystroke an editor has the diagnostics: the message that changes a letter in the middle of a large
// file, as bytes, to the message with the diagnostics, as bytes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "editor/lsp/language_server.hpp"

namespace opentmcl::editor::lsp {
namespace {

const std::string uri = "file:///lab/large.tmc";

/// What a large program looks like, with a mistake now and then.
std::string source(int line_count) {
  std::string text = "#include TMCLParam.tmc\nSpeed = 500\n";
  for (int line = 2, block = 0; line < line_count; line += 10, ++block) {
    const std::string n = std::to_string(block);
    const std::string next = std::to_string(block + 10 < line_count / 10 ? block + 1 : 0);
    text += "// Block " + n + "\nBlock" + n + ":\n";
    text += "    SAP APMaxPositioningSpeed, Motor0, Speed + " + n + "\n    SAP 5, 0, 500\n";
    text += "    MVP ABS, 0, " + n + " * 100\n    WAIT POS, 0, 500 // five seconds\n    JC ETO, Block" + next + "\n";
    text += block % 20 == 0 ? "    SAP 4, 0, 51200\n" : "    GIO 0, 0\n";
    text += "    COMP 1\n    JC EQ, Block" + next + "\n";
  }
  return text;
}

void diagnostics_after_a_keystroke(benchmark::State& state) {
  lang::MemoryFiles files;
  std::string sent;
  LanguageServer server([&](const json& message) { sent = message.dump(); }, files);
  const auto take = [&](const std::string& bytes) { server.take(json::parse(bytes)); };
  const json text = source(static_cast<int>(state.range(0)));
  take(R"({"jsonrpc":"2.0","id":0,"method":"initialize","params":{"capabilities":{}}})");
  take(R"({"jsonrpc":"2.0","method":"initialized","params":{}})");
  take(R"({"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":{"uri":")" + uri +
       R"(","languageId":"tmcl","version":0,"text":)" + text.dump() + "}}}");
  server.publish();
  int version = 0;
  std::vector<double> times;  // ms
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    // A letter goes into a comment in the middle, and away again.
    const std::string line = std::to_string(state.range(0) / 2 / 10 * 10 + 2);
    const bool is_insertion = ++version % 2 == 1;
    const std::string end = is_insertion ? "3" : "4";
    const std::string letter = is_insertion ? "x" : "";
    take(R"({"jsonrpc":"2.0","method":"textDocument/didChange","params":{"textDocument":{"uri":")" + uri +
         R"(","version":)" + std::to_string(version) + R"(},"contentChanges":[{"range":{"start":{"line":)" + line +
         R"(,"character":3},"end":{"line":)" + line + R"(,"character":)" + end + R"(}},"text":")" + letter +
         R"("}]}})");
    sent.clear();
    server.publish();
    if (sent.empty()) state.SkipWithError("nothing was published");
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  state.counters["median_ms"] = times[times.size() / 2];
}
BENCHMARK(diagnostics_after_a_keystroke)->Arg(5000)->Arg(50000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opentmcl::editor::lsp
