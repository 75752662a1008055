#include "apps/tmcl/line_editor.hpp"

#include <histedit.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace opentmcl::app {

struct LineEditor::State {
  Completions completions;
  std::string history_file;
  std::string prompt;
  std::function<bool()> wants_to_end;
  bool was_interrupted = false;
  EditLine* editor = nullptr;
  History* history = nullptr;
};

namespace {

constexpr int kept_lines = 1000;

LineEditor::State& state_of(EditLine* editor) {
  void* state = nullptr;
  el_get(editor, EL_CLIENTDATA, &state);
  return *static_cast<LineEditor::State*>(state);
}

const char* prompt_of(EditLine* editor) {
  return state_of(editor).prompt.c_str();
}

/// Waits with poll(), which a signal interrupts: read() would go on waiting. Now and then it looks whether one came
/// just before.
int read_character(EditLine* editor, wchar_t* character) {
  LineEditor::State& state = state_of(editor);
  while (true) {
    constexpr int now_and_then = 200;  // ms
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = ::poll(&input, 1, now_and_then);
    if (ready < 0 && errno != EINTR) return -1;
    if (state.wants_to_end()) {
      state.was_interrupted = true;
      return 0;
    }
    if (ready <= 0) continue;
    unsigned char byte = 0;
    const ssize_t count = ::read(STDIN_FILENO, &byte, 1);
    if (count <= 0) return static_cast<int>(count);
    *character = byte;
    return 1;
  }
}

std::string common_begin(const std::vector<std::string>& words) {
  std::string begin = words.front();
  for (const std::string& word : words) {
    const auto differing = std::mismatch(begin.begin(), begin.end(), word.begin(), word.end()).first;
    begin.erase(differing, begin.end());
  }
  return begin;
}

/// The TAB key.
unsigned char complete(EditLine* editor, int) {
  const LineInfo* const info = el_line(editor);
  const std::string_view line(info->buffer, static_cast<std::size_t>(info->cursor - info->buffer));
  std::vector<std::string> words = state_of(editor).completions(line);
  if (words.empty()) return CC_REFRESH_BEEP;
  const std::size_t blank = line.find_last_of(" \t(,{");
  const std::size_t typed = blank == std::string_view::npos ? line.size() : line.size() - blank - 1;
  std::string rest = common_begin(words);
  if (words.size() == 1) {
    rest += ' ';
  } else if (rest.size() <= typed) {
    std::sort(words.begin(), words.end());
    std::fputc('\n', stdout);
    for (const std::string& word : words) std::printf("%s  ", word.c_str());
    std::fputc('\n', stdout);
    std::fflush(stdout);
    return CC_REDISPLAY;
  }
  // What was typed may be in another case.
  el_deletestr(editor, static_cast<int>(typed));
  return el_insertstr(editor, rest.c_str()) == 0 ? CC_REFRESH : CC_REFRESH_BEEP;
}

}  // namespace

LineEditor::LineEditor(Completions completions, std::string history_file) : state_(std::make_unique<State>()) {
  state_->completions = std::move(completions);
  state_->history_file = std::move(history_file);
  state_->history = history_init();
  HistEvent event;
  history(state_->history, &event, H_SETSIZE, kept_lines);
  history(state_->history, &event, H_SETUNIQUE, 1);
  // There is none before the first run.
  if (!state_->history_file.empty()) history(state_->history, &event, H_LOAD, state_->history_file.c_str());
  state_->editor = el_init("tmcl", stdin, stdout, stderr);
  EditLine* const editor = state_->editor;
  el_set(editor, EL_CLIENTDATA, state_.get());
  el_set(editor, EL_PROMPT, prompt_of);
  el_set(editor, EL_EDITOR, "emacs");
  el_set(editor, EL_HIST, history, state_->history);
  // The wide form keeps these texts; the other one makes copies of them that nobody frees.
  el_wset(editor, EL_ADDFN, L"tmcl-complete", L"Complete a word", complete);
  el_set(editor, EL_BIND, "^I", "tmcl-complete", nullptr);
  el_set(editor, EL_BIND, "^R", "em-inc-search-prev", nullptr);
  el_set(editor, EL_GETCFN, read_character);
}

LineEditor::~LineEditor() {
  HistEvent event;
  if (!state_->history_file.empty()) history(state_->history, &event, H_SAVE, state_->history_file.c_str());
  el_end(state_->editor);
  history_end(state_->history);
}

LineEditor::Answer LineEditor::read(const std::string& prompt, const std::function<bool()>& wants_to_end) {
  state_->prompt = prompt;
  state_->wants_to_end = wants_to_end;
  state_->was_interrupted = false;
  int length = 0;
  const char* const text = el_gets(state_->editor, &length);
  if (state_->was_interrupted) {
    std::fputc('\n', stdout);
    el_reset(state_->editor);
    return {Outcome::interrupted, {}};
  }
  if (text == nullptr || length <= 0) {
    std::fputc('\n', stdout);
    return {Outcome::end, {}};
  }
  std::string line(text, static_cast<std::size_t>(length));
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
  if (!line.empty()) {
    HistEvent event;
    history(state_->history, &event, H_ENTER, line.c_str());
  }
  return {Outcome::line, std::move(line)};
}

}  // namespace opentmcl::app
