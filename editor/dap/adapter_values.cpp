// What the client sees of a program that stands, and what it changes there.

#include <algorithm>
#include <utility>

#include "editor/dap/adapter.hpp"
#include "editor/dap/memory.hpp"
#include "editor/dap/variable_view.hpp"

namespace opentmcl::editor::dap {

using client::ErrorKind;
using client::Result;

Answer Adapter::stack_trace(const json& arguments) {
  const Result<std::int64_t> start = optional_integer(arguments, "startFrame", 0);
  if (!start) return start.error();
  const Result<std::int64_t> levels = optional_integer(arguments, "levels", 0);
  if (!levels) return levels.error();
  json frames = json::array();
  for (const debug::Frame& open : engine_->frames()) {
    const bool has_label = !engine_->program().place_of(open.address).label.empty();
    std::string name = (has_label ? "" : "address ") + engine_->program().name_of(open.address);
    if (open.is_interrupt) name += " (interrupt routine)";
    json frame{{"id", frames.size() + 1},
               {"name", std::move(name)},
               {"line", 0},
               {"column", 0},
               {"instructionPointerReference", memory_reference(open.address)}};
    sources_->put_place(frame, open.address, client_);
    if (frame.find("source") == frame.end()) frame["presentationHint"] = "subtle";
    frames.push_back(std::move(frame));
  }
  if (!engine_->frames_are_whole()) {
    frames.push_back({{"id", frames.size() + 1},
                      {"name", "(there may be more: not all steps were seen)"},
                      {"line", 0},
                      {"column", 0},
                      {"presentationHint", "label"}});
  }
  const auto total = static_cast<std::int64_t>(frames.size());
  const std::int64_t begin = std::clamp<std::int64_t>(*start, 0, total);
  const std::int64_t end = *levels > 0 && *levels < total - begin ? begin + *levels : total;
  json wanted = json::array();
  for (std::int64_t i = begin; i < end; ++i) wanted.push_back(frames[static_cast<std::size_t>(i)]);
  return json{{"stackFrames", std::move(wanted)}, {"totalFrames", total}};
}

Answer Adapter::scopes(const json& /*arguments*/) {
  return VariableView(*engine_).scopes();
}

Answer Adapter::variables(const json& arguments) {
  return VariableView(*engine_).variables(arguments);
}

/// One value can depend on another: a physical value on the divisors, a scope on the parameter that was set.
void Adapter::tell_of_change() {
  if (client_.knows_invalidated) tell_afterwards("invalidated", {{"areas", {"variables"}}});
}

Answer Adapter::set_variable(const json& arguments) {
  const Result<std::int64_t> reference = required_integer(arguments, "variablesReference");
  if (!reference) return reference.error();
  const Result<std::string> name = required_text(arguments, "name");
  if (!name) return name.error();
  const Result<std::string> value = required_text(arguments, "value");
  if (!value) return value.error();
  const VariableView view(*engine_);
  const Result<std::string> expression = view.expression_of(*reference, *name);
  if (!expression) return expression.error();
  const Result<std::string> assigned = view.assign(*expression, *value);
  if (!assigned) return assigned.error();
  tell_of_change();
  return json{{"value", *assigned}, {"variablesReference", 0}};
}

Answer Adapter::set_expression(const json& arguments) {
  const Result<std::string> expression = required_text(arguments, "expression");
  if (!expression) return expression.error();
  const Result<std::string> value = required_text(arguments, "value");
  if (!value) return value.error();
  const Result<std::string> assigned = VariableView(*engine_).assign(*expression, *value);
  if (!assigned) return assigned.error();
  tell_of_change();
  return json{{"value", *assigned}, {"variablesReference", 0}};
}

/// Only what a person types in the console changes anything.
Answer Adapter::evaluate(const json& arguments) {
  const Result<std::string> text = required_text(arguments, "expression");
  if (!text) return text.error();
  const Result<std::string> context = optional_text(arguments, "context");
  if (!context) return context.error();
  Result<std::string> value = VariableView(*engine_).value_of(*text);
  const bool may_execute = *context == "repl" && debug::Engine::is_instruction(*text);
  if (!value && value.error().kind == ErrorKind::usage && may_execute) {
    const Result<std::int32_t> reply = engine_->execute(*text);
    if (!reply) return reply.error();
    value = std::to_string(*reply);
    tell_of_change();
  }
  if (!value) return value.error();
  return json{{"result", *value}, {"variablesReference", 0}};
}

Answer Adapter::source(const json& arguments) {
  Result<std::int64_t> reference = optional_integer(member(arguments, "source"), "sourceReference", 0);
  if (reference.ok() && *reference == 0) reference = required_integer(arguments, "sourceReference");
  if (!reference) return reference.error();
  const Result<std::string> text = sources_->text(*reference);
  if (!text) return text.error();
  return json{{"content", *text}};
}

Answer Adapter::loaded_sources(const json& /*arguments*/) {
  return json{{"sources", sources_->all()}};
}

Answer Adapter::read_memory_request(const json& arguments) {
  return read_memory(*engine_, arguments);
}

Answer Adapter::disassemble_request(const json& arguments) {
  return disassemble(*engine_, *sources_, client_, arguments);
}

}  // namespace opentmcl::editor::dap
