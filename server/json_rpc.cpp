#include "server/json_rpc.hpp"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace opentmcl::server {

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// More than this is no batch but a flood.
constexpr std::size_t largest_batch = 1000;

/// One line; bytes that are no UTF-8, which only a file's name can bring in, are replaced.
std::string text_of(const ordered_json& value) {
  constexpr int no_indentation = -1;
  return value.dump(no_indentation, ' ', false, ordered_json::error_handler_t::replace);
}

ordered_json response(const json& id, const RpcOutcome& outcome) {
  ordered_json response{{"jsonrpc", "2.0"}, {"id", id}};
  if (const auto* error = std::get_if<RpcError>(&outcome)) {
    response["error"] = {{"code", static_cast<int>(error->code)}, {"message", error->message}};
  } else {
    response["result"] = std::get<ordered_json>(outcome);
  }
  return response;
}

RpcError invalid_request(const char* why) {
  return {RpcError::invalid_request, why};
}

/// Gathers the responses to the requests of one text.
class Responses {
 public:
  Responses(bool is_batch, std::function<void(std::string)> respond)
      : is_batch_(is_batch), respond_(std::move(respond)) {}
  Responses(const Responses&) = delete;
  Responses& operator=(const Responses&) = delete;
  /// Who holds this has an answer to give; when nobody does any more, all are there.
  ~Responses() {
    if (responses_.empty()) return;
    if (is_batch_) {
      respond_(text_of(ordered_json(std::move(responses_))));
    } else {
      respond_(text_of(responses_.front()));
    }
  }

  void add(ordered_json response) { responses_.push_back(std::move(response)); }

 private:
  bool is_batch_;
  std::function<void(std::string)> respond_;
  std::vector<ordered_json> responses_;
};

bool is_id(const json& id) {
  return id.is_string() || id.is_number() || id.is_null();
}

void take_request(const json& request, const RpcCall& call, const std::shared_ptr<Responses>& responses) {
  const auto refuse = [&](const json& id, const RpcError& error) { responses->add(response(id, error)); };
  if (!request.is_object()) return refuse(nullptr, invalid_request("a request is a JSON object"));
  const auto id = request.find("id");
  if (id != request.end() && !is_id(*id)) return refuse(nullptr, invalid_request("\"id\" is a string or a number"));
  const json known_id = id != request.end() ? *id : json();
  const auto version = request.find("jsonrpc");
  if (version == request.end() || *version != "2.0") {
    return refuse(known_id, invalid_request(R"("jsonrpc" has to be "2.0")"));
  }
  const auto method = request.find("method");
  if (method == request.end() || !method->is_string()) {
    return refuse(known_id, invalid_request("\"method\" has to be a string"));
  }
  const auto params = request.find("params");
  if (params != request.end() && !params->is_object() && !params->is_array()) {
    return refuse(known_id, invalid_request("\"params\" has to be an object or an array"));
  }
  const json given = params != request.end() ? *params : json();
  const auto name = method->get<std::string>();
  if (id == request.end()) {
    call(name, given, [](const RpcOutcome&) {});
  } else {
    call(name, given,
         [responses, known_id](const RpcOutcome& outcome) { responses->add(response(known_id, outcome)); });
  }
}

}  // namespace

void take_json_rpc(std::string_view text, const RpcCall& call, std::function<void(std::string)> respond) {
  constexpr bool with_exceptions = false;
  const json parsed = json::parse(text, nullptr, with_exceptions);
  if (parsed.is_discarded()) {
    respond(json_rpc_refusal({RpcError::parse_error, "this is no JSON text"}));
    return;
  }
  if (!parsed.is_array()) {
    take_request(parsed, call, std::make_shared<Responses>(false, std::move(respond)));
    return;
  }
  if (parsed.empty() || parsed.size() > largest_batch) {
    respond(json_rpc_refusal(invalid_request("a batch has 1 to 1000 requests")));
    return;
  }
  const auto responses = std::make_shared<Responses>(true, std::move(respond));
  for (const json& request : parsed) take_request(request, call, responses);
}

std::string json_rpc_refusal(const RpcError& error) {
  return text_of(response(nullptr, error));
}

std::string json_rpc_notification(const std::string& method, const ordered_json& params) {
  return text_of({{"jsonrpc", "2.0"}, {"method", method}, {"params", params}});
}

}  // namespace opentmcl::server
