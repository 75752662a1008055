// What a debugger's window shows of the module while its program stands.
#pragma once

#include <cstdint>
#include <string>

#include "debug/engine.hpp"
#include "editor/dap/protocol.hpp"

namespace opentmcl::editor::dap {

/// Scopes and their variables. Nothing is read from the module before it is asked for, and nothing that its reading
/// changes before it is asked for alone.
class VariableView {
 public:
  /// `engine` must outlive this.
  explicit VariableView(debug::Engine& engine) : engine_(engine) {}

  /// The body of a scopes response.
  json scopes() const;
  /// The body of a variables response. Errors: usage, and those of client::Client.
  Answer variables(const json& arguments) const;
  /// The expression that an entry stands for, "GAP(4)" for "maximum positioning speed". Error: usage, if it has none.
  client::Result<std::string> expression_of(std::int64_t reference, const std::string& name) const;

  /// The value of an expression or an instruction that reads, as people want to see it. Errors: usage, and those of
  /// client::Client.
  client::Result<std::string> value_of(const std::string& text) const;
  /// Gives what `expression` stands for the value of another one. @return the value it has then. Errors likewise.
  client::Result<std::string> assign(const std::string& expression, const std::string& value) const;

 private:
  client::Result<json> registers() const;
  client::Result<json> user_variables() const;
  client::Result<json> all_variables(std::int64_t start, std::int64_t count) const;
  client::Result<json> axis() const;
  client::Result<json> global() const;
  client::Result<json> bench() const;
  client::Result<json> read_at_last(std::int64_t reference) const;

  template <class Row>
  client::Result<json> parameter(const Row& row, std::string expression, std::int64_t lazy_reference) const;
  /// The number and what it is physically, with the present settings of the module.
  client::Result<std::string> with_physical_value(Unit unit, std::int32_t value) const;

  debug::Engine& engine_;
};

}  // namespace opentmcl::editor::dap
