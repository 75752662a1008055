// Reads what a TOML file says about the bench of a module.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>

#include "scenario/bench_setup.hpp"
#include "scenario/problem.hpp"
#include "scenario/value_reader.hpp"

namespace opentmcl::scenario {

/// Scenarios have bench_sections() at their top, farms in each [[module]].
class BenchReader {
 public:
  /// @param within what stands before the names of sections in messages: "module." for [module.machine]
  BenchReader(ProblemList& problems, ValueReader& values, std::string within = {})
      : problems_(problems), values_(values), within_(std::move(within)) {}

  /// Of the keys of `table` those of bench_sections(). From then on `values` are for this bench. What has mistakes is
  /// as if it were not given.
  BenchSetup read(const toml::table& table, const ModuleDescription& module);

 private:
  std::string bracketed(std::string_view section) const { return '[' + within_ + std::string(section) + ']'; }
  const toml::table* section(const toml::table& table, std::string_view name);
  void read_machine(const toml::node& node, twin::MachineDimensions& machine);
  void read_encoder(const toml::table& table, const ModuleDescription& module, twin::EncoderProperties& encoder);
  void read_motor(const toml::node& node, std::optional<twin::MotorData>& motor);
  bool is_table_or_name(const toml::node& node, std::string_view section);
  void check(const toml::table& table, const twin::LinearStageDimensions& stage);
  // These two can be anything within the ranges of their keys.
  static void check(const toml::table&, const twin::CircularAxisDimensions&) {}
  static void check(const toml::table&, const twin::RotaryAxisDimensions&) {}
  void check(const toml::table& table, const twin::EncoderProperties& encoder);

  ProblemList& problems_;
  ValueReader& values_;
  std::string within_;
};

}  // namespace opentmcl::scenario
