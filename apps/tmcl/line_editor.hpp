#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace opentmcl::app {

/// Reads lines from a terminal, with history and completion (libedit). The history is kept in a file from one run to
/// the next.
class LineEditor {
 public:
  /// Whole words that can stand in place of the last one of a line.
  using Completions = std::function<std::vector<std::string>(std::string_view line)>;

  /// @param history_file empty: the history ends with this; a file that cannot be written is no reason to stop
  LineEditor(Completions completions, std::string history_file);
  ~LineEditor();
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  enum class Outcome { line, end, interrupted };
  struct Answer {
    Outcome outcome;
    std::string line;
  };
  /// @param wants_to_end asked when a signal has come; true ends the line as Ctrl-C does
  Answer read(const std::string& prompt, const std::function<bool()>& wants_to_end);

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace opentmcl::app
