// Where the client wants the program to stop.

#include <algorithm>

#include "editor/dap/adapter.hpp"
#include "editor/dap/capabilities.hpp"
#include "editor/dap/variable_view.hpp"

namespace opentmcl::editor::dap {

using client::Result;
using Kind = BreakpointSets::Kind;

Answer Adapter::set_breakpoints(const json& arguments) {
  return breakpoints_.set(Kind::line, arguments, breakpoint_place());
}

Answer Adapter::set_function_breakpoints(const json& arguments) {
  return breakpoints_.set(Kind::function, arguments, breakpoint_place());
}

Answer Adapter::set_instruction_breakpoints(const json& arguments) {
  return breakpoints_.set(Kind::instruction, arguments, breakpoint_place());
}

Answer Adapter::set_data_breakpoints(const json& arguments) {
  return breakpoints_.set(Kind::data, arguments, breakpoint_place());
}

/// The id of a value is the expression it goes by, which is the same in every session.
Answer Adapter::data_breakpoint_info(const json& arguments) {
  const Result<std::string> name = required_text(arguments, "name");
  if (!name) return name.error();
  const Result<std::int64_t> reference = optional_integer(arguments, "variablesReference", 0);
  if (!reference) return reference.error();
  const VariableView view(*engine_);
  const Result<std::string> expression = *reference == 0 ? *name : view.expression_of(*reference, *name);
  if (!expression) return expression.error();
  // Quantities of the bench are conditions on signals, which a function breakpoint has.
  const Result<double> value = engine_->evaluate(*expression);
  if (!value || debug::Engine::is_instruction(*expression)) {
    const std::string reason = value.ok() ? "an instruction is no value that changes" : value.error().message;
    return json{{"dataId", nullptr}, {"description", reason}};
  }
  return json{{"dataId", *expression}, {"description", *expression}, {"accessTypes", {"write"}}, {"canPersist", true}};
}

Answer Adapter::set_exception_breakpoints(const json& arguments) {
  const Result<std::uint8_t> troubles = troubles_of_filters(arguments);
  if (!troubles) return troubles.error();
  troubles_ = request_.without_debugging ? std::uint8_t{0} : *troubles;
  engine_->stop_at_troubles(troubles_);
  return json::object();
}

Answer Adapter::exception_info(const json& /*arguments*/) {
  const debug::Stop& stop = engine_->stop();
  if (stop.reason != debug::Stop::Reason::trouble) return mistake("the program was not stopped by an exception");
  return json{{"exceptionId", stop.description}, {"breakMode", "always"}};
}

Answer Adapter::breakpoint_locations(const json& arguments) {
  const Result<lang::FileId> file = sources_->find(member(arguments, "source"));
  if (!file) return file.error();
  const Result<std::int64_t> line = required_integer(arguments, "line");
  if (!line) return line.error();
  const Result<std::int64_t> end_line = optional_integer(arguments, "endLine", *line);
  if (!end_line) return end_line.error();
  const debug::Program& program = engine_->program();
  const auto line_count = static_cast<std::int64_t>(program.line_count(*file));
  const std::int64_t first = std::max<std::int64_t>(client_.line_from_1(std::max<std::int64_t>(*line, 0)), 1);
  const std::int64_t last = client_.line_from_1(std::clamp<std::int64_t>(*end_line, 0, line_count));
  json locations = json::array();
  std::int64_t next = first;
  while (next <= last) {
    const auto address = program.address_of(*file, static_cast<std::size_t>(next));
    if (!address) break;
    const debug::Line found = program.line_of(*address).value_or(debug::Line{});
    next = std::max(next, static_cast<std::int64_t>(found.line)) + 1;
    if (static_cast<std::int64_t>(found.line) > last) break;
    locations.push_back({{"line", client_.line(found.line)}, {"column", client_.column(found.column)}});
  }
  return json{{"breakpoints", std::move(locations)}};
}

}  // namespace opentmcl::editor::dap
