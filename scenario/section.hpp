// The keys of a scenario file as tables: the reader, the JSON schema and the messages all use these rows.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace opentmcl::scenario {

/// What a key can be given. Each uses the member of Value that its comment names.
enum class ValueType : std::uint8_t {
  text,         ///< text
  choice,       ///< text, one of Key::choices
  names,        ///< texts: names of signals
  truth,        ///< truth
  time,         ///< time
  number,       ///< number, in Key::unit
  whole,        ///< the same, without a fraction
  condition,    ///< condition
  assignments,  ///< assignments: a table of quantities
  command,      ///< commands: exactly one
  commands,     ///< commands: one, or an array of them
};

struct Value {
  double number = 0;
  Microseconds time = 0;
  bool truth = false;
  std::string text = {};
  std::vector<std::string> texts = {};
  Condition condition = {};
  std::vector<Assignment> assignments = {};
  std::vector<HostCommand> commands = {};
};

/// A key of a section whose content ends up in a `Target`.
template <class Target>
struct Key {
  std::string_view name;
  ValueType type;
  std::string_view description;
  void (*store)(Target& target, Value&& value);
  std::string_view unit = {};  ///< of a number
  double lowest = 0;           ///< of a number; of a time in us, 0 or 1
  double highest = 0;
  std::span<const std::string_view> choices = {};
  bool required = false;
  /// The other module has no use for it.
  const ModuleDescription* only_for = nullptr;
};

/// Section names as they are written in the file.
inline constexpr std::string_view machine_section = "machine";
inline constexpr std::string_view encoder_section = "encoder";
inline constexpr std::string_view motor_section = "motor";
inline constexpr std::string_view load_section = "load";
inline constexpr std::string_view initial_section = "initial";
inline constexpr std::string_view record_section = "record";
inline constexpr std::string_view event_section = "event";
inline constexpr std::string_view expect_section = "expect";

struct SectionName {
  std::string_view name;
  std::string_view description;
  bool repeated;  ///< [[name]] instead of [name]
};

std::span<const SectionName> sections();
/// Those of them that say what stands on the bench.
std::span<const SectionName> bench_sections();

std::span<const Key<Scenario>> root_keys();
std::span<const Key<twin::EncoderProperties>> encoder_keys();
std::span<const Key<twin::MotorData>> motor_keys();
std::span<const Key<Recording>> record_keys();
std::span<const Key<Event>> event_keys();
std::span<const Key<Expectation>> expect_keys();

inline constexpr std::string_view program_key = "program";

// ---- The motor: what its name stands for can be changed by other keys

inline constexpr std::string_view motor_name_key = "name";
/// The motor whose rotor is always where the field is. Nothing else can be said of it.
inline constexpr std::string_view ideal_motor = "ideal";

/// The one that is taken when nothing is said of it first.
std::vector<std::string_view> motor_names();

// ---- The load: quantities whose names begin so

inline constexpr std::string_view load_prefix = "load.";

// ---- The machine: its kind says which keys there are

inline constexpr std::string_view machine_kind_key = "kind";

struct MachineKind {
  std::string_view name;
  std::string_view description;
};

std::span<const Key<twin::LinearStageDimensions>> linear_stage_keys();
std::span<const Key<twin::CircularAxisDimensions>> circular_axis_keys();
std::span<const Key<twin::RotaryAxisDimensions>> rotary_axis_keys();

/// Calls `visitor(kind, keys, dimensions)` for each, with the dimensions when nothing is said of them; the first one is
/// the kind when nothing is said of that.
template <class Visitor>
void for_each_machine_kind(Visitor&& visitor) {
  visitor(MachineKind{"stage", "A slider on a screw, with its switches."}, linear_stage_keys(),
          twin::LinearStageDimensions{});
  visitor(MachineKind{"circular", "A table behind a gear, with a home mark."}, circular_axis_keys(),
          twin::CircularAxisDimensions{});
  visitor(MachineKind{"free", "A shaft without end and without switches."}, rotary_axis_keys(),
          twin::RotaryAxisDimensions{});
}

}  // namespace opentmcl::scenario
