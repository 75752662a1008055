// Reads a section of a TOML file whose keys are rows of a table.
#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lang/diagnostic.hpp"
#include "scenario/problem.hpp"
#include "scenario/section.hpp"
#include "scenario/toml_place.hpp"
#include "scenario/value_reader.hpp"

namespace opentmcl::scenario {

/// Stores what it understands and complains of the rest.
/// @param name what messages call the section
/// @param elsewhere names that may stand there too, but are read by somebody else
template <class Target>
void read_section(ValueReader& values, const toml::table& table, std::span<const Key<Target>> keys, Target& target,
                  std::string_view name, const std::vector<std::string_view>& elsewhere = {}) {
  for (const auto& [key, node] : table) {
    const std::string_view word = key.str();
    if (std::find(elsewhere.begin(), elsewhere.end(), word) != elsewhere.end()) continue;
    const auto found =
        std::find_if(keys.begin(), keys.end(), [word](const Key<Target>& row) { return row.name == word; });
    if (found == keys.end()) {
      std::vector<std::string_view> known = elsewhere;
      for (const Key<Target>& row : keys) known.push_back(row.name);
      values.complain(place_of(key.source()),
                      std::string(name) + " has no " + lang::in_quotes(word) + ": " + nearest_or_all(word, known));
    } else if (std::optional<Value> value =
                   values.read(node, found->type, {found->unit, found->lowest, found->highest, found->choices})) {
      found->store(target, std::move(*value));
    }
  }
  for (const Key<Target>& key : keys) {
    if (key.required && !table.contains(key.name)) {
      values.complain(place_of(table),
                      std::string(name) + " lacks " + std::string(key.name) + ": " + std::string(key.description));
    }
  }
}

}  // namespace opentmcl::scenario
