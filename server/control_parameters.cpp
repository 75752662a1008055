// What all methods of the control interface share: their parameters, and how they are described.
#include <algorithm>

#include "server/control_methods.hpp"

namespace opentmcl::server {

namespace {

using nlohmann::json;
using Type = ControlParameter::Type;

RpcError wrong(const std::string& what) {
  return {RpcError::invalid_params, what};
}

/// Why `given` is none of its type, or nullptr.
const char* objection(Type type, const json& given) {
  const auto is_text = [](const json& element) { return element.is_string(); };
  const auto is_value = [](const json& element) { return element.is_number() || element.is_boolean(); };
  switch (type) {
    case Type::count:
      return given.is_number_integer() && given >= 0 ? nullptr : "a whole number, not negative";
    case Type::text:
      return given.is_string() ? nullptr : "a string";
    case Type::names:
      return is_text(given) || (given.is_array() && std::all_of(given.begin(), given.end(), is_text))
                 ? nullptr
                 : "a name or an array of names";
    case Type::values:
      return given.is_object() && std::all_of(given.begin(), given.end(), is_value)
                 ? nullptr
                 : "an object of names with numbers, true or false";
    case Type::speed:
      return given == "max" || (given.is_number() && given.get<double>() > 0) ? nullptr
                                                                              : "a number above 0, or \"max\"";
  }
  return nullptr;
}

const ControlParameter* find_parameter(const ControlMethod& method, const std::string& name) {
  for (const ControlParameter& parameter : method.used_parameters()) {
    if (name == parameter.name) return &parameter;
  }
  return nullptr;
}

json object_of(const ControlMethod& method, const json& array) {
  json object = json::object();
  const auto parameters = method.used_parameters();
  for (std::size_t i = 0; i < array.size() && i < parameters.size(); ++i) object[parameters[i].name] = array[i];
  return object;
}

}  // namespace

const char* name_of(ControlParameter::Type type) {
  switch (type) {
    case Type::count:
      return "count";
    case Type::text:
      return "text";
    case Type::names:
      return "names";
    case Type::values:
      return "values";
    case Type::speed:
      return "speed";
  }
  return "";
}

std::optional<RpcError> name_parameters(const ControlMethod& method, const json& given, json& named) {
  const std::string name = method.name;
  if (given.is_array() && given.size() > method.used_parameters().size()) {
    return wrong(name + " has " + std::to_string(method.used_parameters().size()) + " parameters");
  }
  named = given.is_array() ? object_of(method, given) : given.is_null() ? json::object() : given;
  for (const auto& [key, value] : named.items()) {
    const ControlParameter* parameter = find_parameter(method, key);
    if (parameter == nullptr) return wrong(std::string(name).append(" has no parameter \"").append(key).append("\""));
    if (const char* expected = objection(parameter->type, value)) {
      return wrong(std::string(key).append(" of ").append(name).append(" has to be ").append(expected));
    }
  }
  for (const ControlParameter& parameter : method.used_parameters()) {
    if (parameter.is_required && !named.contains(parameter.name)) return wrong(name + " needs " + parameter.name);
  }
  return std::nullopt;
}

std::string control_reference() {
  std::string text = "| Method | Parameters | Result besides `time` |\n|---|---|---|\n";
  for (const ControlMethod& method : control_methods()) {
    text += "| **" + std::string(method.name) + "**: " + method.description + " | ";
    for (const ControlParameter& parameter : method.used_parameters()) {
      if (&parameter != method.parameters) text += "<br>";
      text += '`' + std::string(parameter.name) + "` (" + name_of(parameter.type) +
              (parameter.is_required ? "): " : ", optional): ") + parameter.description;
    }
    text += " | " + std::string(method.result) + " |\n";
  }
  return text;
}

}  // namespace opentmcl::server
