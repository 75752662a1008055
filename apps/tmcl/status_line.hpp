#pragma once

#include <chrono>
#include <cstdio>
#include <string>

namespace opentmcl::app {

/// A line on stderr that is written over again and again on a terminal; elsewhere one line after the other.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine() { end(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  bool is_terminal() const { return is_terminal_; }
  /// How often it is worth showing something new.
  std::chrono::milliseconds period() const { return std::chrono::milliseconds(is_terminal_ ? 100 : 1000); }

  void show(const std::string& text);
  /// What is shown stays; further output begins on a new line.
  void end();
  /// There is nothing to stay: it was overwritten with nothing.
  void forget() { is_open_ = false; }

 private:
  bool is_terminal_;
  bool is_open_ = false;
};

}  // namespace opentmcl::app
