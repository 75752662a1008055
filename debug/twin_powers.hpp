#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/error.hpp"
#include "firmware/hal/time.hpp"
#include "firmware/spec/instructions.hpp"

namespace opentmcl::debug {

/// What the last comparison came to, as the conditions of JC ask for it.
enum class Comparison : std::uint8_t { lower, equal, greater };

/// What no command shows of a program: registers that only instructions see.
struct InnerState {
  Comparison comparison = Comparison::equal;
  std::uint8_t error_flags = 0;  ///< bit n is the flag n + 1 of CLE
  /// Where the open subroutines return to, the outermost first.
  std::array<std::uint16_t, maximum_open_calls> return_addresses{};
  std::size_t depth = 0;
  /// Where RETI returns to, while an interrupt routine is open.
  std::optional<std::uint16_t> interrupted;
  /// How many subroutines were open when it was entered.
  std::size_t interrupted_depth = 0;
  /// Numbers of the interrupts that are enabled; 255 among them: their processing is.
  std::vector<std::uint8_t> enabled_interrupts;
};

/// A place in the history of a twin: the same time can see several turns of the firmware.
struct Moment {
  Microseconds time = 0;
  std::uint64_t turns = 0;  ///< taken by the firmware up to here

  friend constexpr bool operator==(const Moment&, const Moment&) = default;
  friend constexpr bool operator<(const Moment& left, const Moment& right) {
    return left.turns != right.turns ? left.turns < right.turns : left.time < right.time;
  }
};

/// A condition on what a probe would measure: "velocity > 500 and not left_switch".
class Signal {
 public:
  virtual ~Signal() = default;
  virtual bool holds() const = 0;
  /// What it is made of: "velocity is 512, left_switch is 0".
  virtual std::string values() const = 0;
};

/// Something that happens to a motor and that one may want to stop at, as a bit.
enum class Trouble : std::uint8_t { stall = 1, deviation = 2, under_voltage = 4 };

/// What a twin can do and silicon cannot. Looking changes nothing.
class TwinPowers {
 public:
  virtual InnerState inner_state() const = 0;
  /// Open routines, that of an interrupt included.
  virtual std::size_t depth() const = 0;

  // ---- History: whatever was done to the module from outside is remembered and done again

  virtual Moment now() const = 0;
  /// Where the last restart() left the program.
  virtual Moment beginning() const = 0;
  /// Goes to a moment that was, earlier or later. What was done from outside after it is done again on the way forth,
  /// until something new is done; then it is forgotten.
  /// @param keep_going asked now and then; false ends the journey somewhere before `moment`
  /// Errors: interrupted; internal (the moment was none of this history).
  virtual client::Result<void> go_to(Moment moment, const std::function<bool()>& keep_going) = 0;

  // ---- The bench

  /// Conditions are those of scenarios (docs/scenarios.md). Error: usage, with what was expected and where. The twin
  /// must outlive the signal.
  virtual client::Result<std::unique_ptr<Signal>> signal(std::string_view condition) = 0;
  /// "velocity is 512". Error: usage.
  virtual client::Result<std::string> quantity(std::string_view name) const = 0;
  /// Error: usage.
  virtual client::Result<void> set_quantity(std::string_view name, double value) = 0;
  virtual std::vector<std::string_view> quantity_names() const = 0;

  /// Trouble bits: what has happened and was not acknowledged by a new motion command or by reading parameter 207; for
  /// under_voltage: the motor supply is too low.
  virtual std::uint8_t troubles() const = 0;

 protected:
  ~TwinPowers() = default;
};

}  // namespace opentmcl::debug
