#pragma once

namespace opentmcl::app {

/// While one exists, Ctrl-C and SIGTERM do not end the program but are remembered. Only one at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// Whether one of them has come.
  bool requested() const;
  /// The same, and from then on it has not come.
  bool take() const;
};

}  // namespace opentmcl::app
