#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "server/json_rpc.hpp"

namespace opentmcl::server {

class Control;
class ControlClient;

/// A request on its way through a method.
struct ControlCall {
  Control& control;
  ControlClient& client;
  /// Checked: an object whose members are parameters of the method, each of its type, all that are required.
  const nlohmann::json& parameters;
  const RpcAnswer& answer;
};

struct ControlParameter {
  enum class Type : std::uint8_t {
    count,   ///< a whole number, not negative
    text,    ///< a string
    names,   ///< a quantity's name, or an array of them
    values,  ///< an object: quantities' names and their new values
    speed,   ///< a number above 0, or "max"
  };

  const char* name;
  Type type;
  bool is_required;
  const char* description;
};

/// A method of the control interface. docs/control.md and "describe" tell what is in these rows.
struct ControlMethod {
  static constexpr std::size_t most_parameters = 3;

  const char* name;
  const char* description;
  ControlParameter parameters[most_parameters];  ///< those with a name
  const char* result;                            ///< what the result has besides the time
  void (*handle)(ControlCall& call);

  std::span<const ControlParameter> used_parameters() const;
};

std::span<const ControlMethod> control_methods();
/// nullptr when there is none.
const ControlMethod* find_control_method(std::string_view name);

/// "count", …
const char* name_of(ControlParameter::Type type);

/// Checks what a client has given, as an object or in the parameters' order, and makes an object of it.
std::optional<RpcError> name_parameters(const ControlMethod& method, const nlohmann::json& given,
                                        nlohmann::json& named);

/// The reference in docs/control.md.
std::string control_reference();

}  // namespace opentmcl::server
