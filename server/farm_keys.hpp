// The keys of a farm file as tables: the reader, its messages and docs/farm.md all use these rows.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "server/farm_description.hpp"

namespace opentmcl::server {

/// What a key can be given.
enum class FarmValueKind : std::uint8_t {
  name,    ///< text of letters, digits, - _ and .
  text,    ///< any text that is not empty
  path,    ///< text; from the folder of the file on
  group,   ///< "GROUP:PORT"
  truth,   ///< true or false
  number,  ///< a whole number within limits
};

struct FarmValue {
  std::string text = {};
  std::int64_t number = 0;
  bool truth = false;
};

/// One [[module]] before it is multiplied, with the names of what it refers to.
struct FarmModuleEntry {
  FarmModule module;
  std::int64_t count = 1;
  std::string rs485 = {};
  std::string can = {};
};

/// A key of a section whose content ends up in a `Target`.
template <class Target>
struct FarmKey {
  std::string_view name;
  FarmValueKind kind;
  std::string_view description;
  void (*store)(Target& target, FarmValue&& value);
  std::int64_t lowest = 0;  ///< of a number
  std::int64_t highest = 0;
  std::span<const std::string_view> choices = {};  ///< of a text; empty: any
};

std::span<const FarmKey<FarmDescription>> farm_keys();
std::span<const FarmKey<FarmModuleEntry>> farm_module_keys();
std::span<const FarmKey<FarmRs485Line>> farm_rs485_keys();
std::span<const FarmKey<FarmCanBus>> farm_can_keys();

/// What a key takes, in words: "a whole number, 1 to 255".
std::string farm_expectation(FarmValueKind kind, std::int64_t lowest, std::int64_t highest,
                             std::span<const std::string_view> choices);

inline constexpr std::string_view farm_module_section = "module";
inline constexpr std::string_view farm_rs485_section = "rs485";
inline constexpr std::string_view farm_can_section = "can";
inline constexpr std::string_view farm_sections[] = {farm_module_section, farm_rs485_section, farm_can_section};

/// In the paths of many modules alike: the place of the name of each.
inline constexpr std::string_view farm_name_place = "{name}";

inline constexpr std::int64_t highest_tcp_port = 65'535;

}  // namespace opentmcl::server
