// Reads the values of a scenario file.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/problem.hpp"
#include "scenario/section.hpp"

namespace opentmcl::scenario {

/// What a key's row says about its value.
struct AllowedValues {
  std::string_view unit = {};
  double lowest = 0;
  double highest = 0;
  std::span<const std::string_view> choices = {};
};

/// Each function complains of what is wrong, at its place, and then returns nothing.
class ValueReader {
 public:
  /// Until it is told otherwise, values are for the default module on the default machine.
  explicit ValueReader(ProblemList& problems);

  /// Commands are for this module, and quantities those of this bench.
  void set_bench(const ModuleDescription& module, const BenchSetup& bench);

  std::optional<Value> read(const toml::node& node, ValueType type, const AllowedValues& allowed);
  /// In the order of the file. Those with mistakes are left out.
  /// @param prefix goes before the names in the table
  std::vector<Assignment> assignments(const toml::table& table, std::string_view prefix = {});

  void complain(Place place, std::string message) { problems_.complain(place, std::move(message)); }
  void complain_of_kind(const toml::node& node, std::string_view expected);

 private:
  std::optional<Value> text(const toml::node& node);
  std::optional<Value> choice(const toml::node& node, std::span<const std::string_view> choices);
  std::optional<Value> names(const toml::node& node);
  /// A number as it is, or one with a unit in a text.
  std::optional<double> any_number(const toml::node& node, std::string_view unit);
  std::optional<Value> number(const toml::node& node, std::string_view unit, double lowest, double highest);
  std::optional<Value> whole(const toml::node& node, const AllowedValues& allowed);
  /// A plain number would be seconds; it is refused, since half of the readers would think of ms.
  std::optional<Value> time(const toml::node& node, double lowest);
  std::optional<Value> condition(const toml::node& node);
  void add_assignments(const toml::table& table, const std::string& prefix, int depth,
                       std::vector<std::pair<Place, Assignment>>& found);
  std::optional<double> assigned_value(const toml::node& node, const twin::Quantity& quantity);
  std::optional<HostCommand> host_command(const toml::node& node);
  std::optional<Value> commands(const toml::node& node);

  ProblemList& problems_;
  const ModuleDescription* module_ = nullptr;
  std::optional<twin::World> world_;  ///< a machine to ask what there is
};

}  // namespace opentmcl::scenario
