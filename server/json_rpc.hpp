#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

namespace opentmcl::server {

/// What JSON-RPC 2.0 calls an error; those from -32000 down to -32099 are for the application.
struct RpcError {
  enum Code : int {
    parse_error = -32700,
    invalid_request = -32600,
    method_not_found = -32601,
    invalid_params = -32602,
    internal_error = -32603,
    bad_file = -32001,      ///< a file is not what it should be
    timeout = -32002,       ///< something took longer than the request allows
    busy = -32003,          ///< another request has to come to its end first
    input_output = -32004,  ///< the operating system refused something
  };

  Code code;
  std::string message;
};

using RpcOutcome = std::variant<nlohmann::ordered_json, RpcError>;
/// Takes the outcome of a call, once, now or later.
using RpcAnswer = std::function<void(const RpcOutcome&)>;
/// Calls a method. `params` is an object or an array, or null when there are none.
using RpcCall = std::function<void(const std::string& method, const nlohmann::json& params, RpcAnswer answer)>;

/// Takes a request, or a batch of them, as JSON-RPC 2.0 has it: calls what is well-formed, and hands one JSON text
/// without a line's end to `respond` when all of it is answered; none if nobody asks for an answer.
void take_json_rpc(std::string_view text, const RpcCall& call, std::function<void(std::string)> respond);

/// A response to what could not even be taken, such as a text that is too long.
std::string json_rpc_refusal(const RpcError& error);
/// A request that is not to be answered.
std::string json_rpc_notification(const std::string& method, const nlohmann::ordered_json& params);

}  // namespace opentmcl::server
