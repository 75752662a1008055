#include "editor/dap/protocol.hpp"

#include <utility>

namespace opentmcl::editor::dap {

using client::Error;
using client::Result;

namespace {

std::string in_quotes(std::string_view text) {
  return std::string("'").append(text).append("'");
}

Error wrong_type(const char* name, const char* expected, const json& found) {
  return mistake(in_quotes(name)
                     .append(" must be ")
                     .append(expected)
                     .append(", not ")
                     .append(found.is_number() ? found.dump() : found.type_name()));
}

Error missing(const char* name, const char* expected) {
  return mistake(in_quotes(name).append(" is missing: expected ").append(expected));
}

constexpr const char* a_text = "a string";
constexpr const char* an_integer = "a whole number";
constexpr const char* a_truth = "true or false";

}  // namespace

const json& member(const json& object, const char* name) {
  static const json nothing;
  if (!object.is_object()) return nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

Result<std::string> required_text(const json& arguments, const char* name) {
  const json& value = member(arguments, name);
  if (value.is_null()) return missing(name, a_text);
  if (!value.is_string()) return wrong_type(name, a_text, value);
  return value.get<std::string>();
}

Result<std::string> optional_text(const json& arguments, const char* name) {
  if (member(arguments, name).is_null()) return std::string();
  return required_text(arguments, name);
}

Result<std::int64_t> required_integer(const json& arguments, const char* name) {
  const json& value = member(arguments, name);
  if (value.is_null()) return missing(name, an_integer);
  // One beyond 63 bits is none that any argument can have.
  if (!value.is_number_integer() || (value.is_number_unsigned() && value.get<std::int64_t>() < 0)) {
    return wrong_type(name, an_integer, value);
  }
  return value.get<std::int64_t>();
}

Result<std::int64_t> optional_integer(const json& arguments, const char* name, std::int64_t otherwise) {
  if (member(arguments, name).is_null()) return otherwise;
  return required_integer(arguments, name);
}

Result<bool> optional_truth(const json& arguments, const char* name, bool otherwise) {
  const json& value = member(arguments, name);
  if (value.is_null()) return otherwise;
  if (!value.is_boolean()) return wrong_type(name, a_truth, value);
  return value.get<bool>();
}

Result<ClientConventions> ClientConventions::read(const json& arguments) {
  ClientConventions client;
  const Result<std::string> format = optional_text(arguments, "pathFormat");
  if (!format) return format.error();
  if (!format->empty() && *format != "path") {
    return mistake(std::string("'pathFormat' must be 'path', not ").append(in_quotes(*format)));
  }
  const Result<bool> lines = optional_truth(arguments, "linesStartAt1", true);
  if (!lines) return lines.error();
  client.first_line = *lines ? 1 : 0;
  const Result<bool> columns = optional_truth(arguments, "columnsStartAt1", true);
  if (!columns) return columns.error();
  client.first_column = *columns ? 1 : 0;
  client.knows_progress = member(arguments, "supportsProgressReporting") == true;
  client.knows_invalidated = member(arguments, "supportsInvalidatedEvent") == true;
  return client;
}

void Outbox::send(json message) {
  message["seq"] = ++last_number_;
  if (!closed_ && !stream_.write(message)) closed_ = true;
}

void Outbox::answer(const json& request, const Answer& answer) {
  const json& number = member(request, "seq");
  const json& command = member(request, "command");
  json response{{"type", "response"},
                {"request_seq", number.is_number_integer() ? number : json(0)},
                {"command", command.is_string() ? command : json("")},
                {"success", answer.ok()}};
  if (answer.ok()) {
    if (!answer->empty()) response["body"] = *answer;
  } else {
    const std::string& message = answer.error().message;
    response["message"] = message;
    response["body"]["error"] = {
        {"id", client::exit_code_of(answer.error().kind)}, {"format", message}, {"showUser", true}};
  }
  send(std::move(response));
}

void Outbox::tell(std::string_view event, json body) {
  json message{{"type", "event"}, {"event", event}};
  if (!body.empty()) message["body"] = std::move(body);
  send(std::move(message));
}

void Outbox::say(Voice voice, std::string text) {
  const char* category = "console";
  if (voice == Voice::problem) category = "stderr";
  if (voice == Voice::program) category = "stdout";
  if (!text.ends_with('\n')) text += '\n';
  tell("output", {{"category", category}, {"output", std::move(text)}});
}

}  // namespace opentmcl::editor::dap
