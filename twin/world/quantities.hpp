// Names for everything around a module that can be looked at or changed while it runs.
//
// One table: scenarios, recordings, the control interface and docs/signals.md all read its rows. To add a quantity, add
// a row in quantities.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "twin/world/world.hpp"

namespace opentmcl::twin {

/// Bit of World::inputs() for ENABLE of the step/direction connector; those for IN0 to IN7 are bits 0 to 7, as those
/// for OUT0 to OUT7 are in World::outputs(). The same as in firmware/hal/pins.hpp, which boards/twin makes sure of.
inline constexpr unsigned step_direction_enable_bit = 11;

struct Quantity {
  enum class Kind : std::uint8_t {
    truth,  ///< 0 or 1
    whole,  ///< a whole number
    real,
  };

  /// Words in lower case, joined by underscores; a dot stands before a part or a property of what is named before it.
  /// Where the signal is in the trace of a World, its name there.
  std::string_view name;
  /// As a person writes it: "V", "mm", "degC"; empty for truths, counts and the chips' own units.
  std::string_view unit;
  std::string_view description;
  Kind kind = Kind::real;
  /// What the trace says for 1 in `unit`: 1000 where it counts mV. 0 for a quantity that is not in the trace.
  double trace_scale = 0;
  /// Whether such a motor moves it between two of its changes in the trace, which has it where spans end
  /// (docs/decisions/0052-spans.md).
  bool follows_rotor = false;
  /// Whether it is one of a motor with a load; an ideal motor has none.
  bool needs_motor = false;
  /// Whether such a motor sets it by itself, so that it can only be written with an ideal one.
  bool set_by_motor = false;
  /// What can be written; without meaning where nothing can.
  double lowest = 0;
  double highest = 0;
  /// The value at this very tick; looking changes nothing. Call it only where exists_in().
  double (*read)(const World& world);
  /// nullptr: cannot be changed. Call it only where refusal() has no objection.
  void (*write)(World& world, double value) = nullptr;
  /// Whether there is such a thing on this machine; nullptr: always.
  bool (*exists)(const World& world) = nullptr;

  bool exists_in(const World& world) const {
    return (!needs_motor || world.motor()) && (exists == nullptr || exists(world));
  }
  /// Whether the trace has each of its changes, at the tick of the change.
  bool is_traced_in(const World& world) const { return trace_scale != 0 && !(follows_rotor && world.motor()); }
  constexpr bool can_be_written() const { return write != nullptr; }
};

/// Something that is only in the trace: an event, or a line that cannot be asked for its level.
struct TraceOnlySignal {
  std::string_view name;
  std::string_view description;
};

/// All of them, those of one subject next to each other.
std::span<const Quantity> quantities();
std::span<const TraceOnlySignal> trace_only_signals();

/// nullptr when nothing has this name.
const Quantity* find_quantity(std::string_view name);

/// Why it does not exist in this world, as the end of a sentence that begins with its name. Nothing if it does.
std::optional<std::string> absence(const Quantity& quantity, const World& world);

/// Why `value`, in the quantity's unit, cannot be written, as the end of a sentence that begins with its name: "can
/// only be looked at". Nothing if it can.
std::optional<std::string> refusal(const Quantity& quantity, const World& world, double value);

/// "24", "0.5", "-3": the shortest text for a value that reads back as the same one.
std::string text_of(double value);

}  // namespace opentmcl::twin
