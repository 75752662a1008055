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
  double lowest = 0;           ///< of a number
  double highest = 0;
  std::span<const std::string_view> choices = {};
  bool required = false;
};

/// Section names as they are written in the file.
inline constexpr std::string_view machine_section = "machine";
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

std::span<const Key<Scenario>> root_keys();
std::span<const Key<MachineDescription>> machine_keys();
std::span<const Key<Recording>> record_keys();
std::span<const Key<Event>> event_keys();
std::span<const Key<Expectation>> expect_keys();

}  // namespace opentmcl::scenario
