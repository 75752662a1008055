#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "client/error.hpp"
#include "debug/twin_powers.hpp"
#include "debug/value_expression.hpp"

namespace opentmcl::debug {

/// At which of its hits a breakpoint stops: "3" and "== 3" the third only, ">= 3" from the third on, "> 3" after it,
/// "% 3" each third.
class HitCondition {
 public:
  /// Error: usage.
  static client::Result<HitCondition> parse(std::string_view text);

  /// @param hits counted from 1
  bool holds(std::uint64_t hits) const;
  std::string text() const;

 private:
  enum class Kind : std::uint8_t { equal, from, after, every };

  Kind kind_ = Kind::from;
  std::uint64_t count_ = 1;
};

/// A message of a logpoint: "A is {A}, position {GAP(1)}"; two braces stand for one.
class LogMessage {
 public:
  /// Error: usage.
  static client::Result<LogMessage> parse(std::string_view text, const Program& program);

  const std::string& text() const { return text_; }
  /// A value that cannot be read shows its error in place.
  std::string fill_in(ValueSource& source) const;

 private:
  std::string text_;
  std::vector<std::variant<std::string, ValueExpression>> pieces_;
};

/// What is wanted, as typed.
struct BreakpointRequest {
  enum class Kind : std::uint8_t {
    address,  ///< before the instruction at `address`
    change,   ///< behind an instruction that changed the value of `subject`, an expression
    signal,   ///< when the signal `subject` becomes true; twins only
  };

  Kind kind = Kind::address;
  std::uint16_t address = 0;
  std::string subject;        ///< of change and signal
  std::string condition;      ///< an expression that must not be 0; empty: always
  std::string hit_condition;  ///< empty: at every hit
  std::string log_message;    ///< not empty: says this and goes on
  bool temporary = false;     ///< gone after it has stopped the program once
};

struct Breakpoint {
  int number = 0;  ///< from 1, never used again
  BreakpointRequest request;
  bool enabled = true;
  std::uint64_t hits = 0;  ///< since the last restart, those whose condition held

  // As understood.
  std::optional<ValueExpression> condition;
  std::optional<HitCondition> hit_condition;
  std::optional<LogMessage> log_message;
  std::optional<ValueExpression> watched;
  std::unique_ptr<Signal> signal;

  // As last looked.
  std::optional<double> last_value;
  bool signal_held = false;

  bool is_logpoint() const { return log_message.has_value(); }
};

/// Error: usage. @param twin nullptr: not a twin
client::Result<Breakpoint> make_breakpoint(BreakpointRequest request, const Program& program, TwinPowers* twin);

}  // namespace opentmcl::debug
