// What happens in a World as a sequence of named signal changes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "twin/physics/tick.hpp"

namespace opentmcl::twin {

/// Hears every change of a signal when it happens. Ticks never run backwards within one signal.
class TraceObserver {
 public:
  virtual void changed(Tick tick, std::string_view signal, std::int64_t value) = 0;

 protected:
  ~TraceObserver() = default;
};

/// A change as text: `tick signal value` and the line's end.
std::string trace_line(Tick tick, std::string_view signal, std::int64_t value);

/// Writes a trace down as text, a line for every change, so that two runs can be compared.
class TraceText : public TraceObserver {
 public:
  void changed(Tick tick, std::string_view signal, std::int64_t value) override;

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace opentmcl::twin
