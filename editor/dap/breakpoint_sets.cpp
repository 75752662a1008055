#include "editor/dap/breakpoint_sets.hpp"

#include <algorithm>
#include <utility>

#include "editor/dap/memory.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::editor::dap {

using client::Result;
using debug::BreakpointRequest;

namespace {

using Kind = BreakpointSets::Kind;

Result<BreakpointRequest> at_line(const json& source, const json& wanted, const BreakpointPlace& place) {
  const Result<lang::FileId> file = place.sources.find(source);
  if (!file) return file.error();
  const Result<std::int64_t> line = required_integer(wanted, "line");
  if (!line) return line.error();
  const std::int64_t from_1 = place.client.line_from_1(*line);
  std::optional<std::uint16_t> address;
  if (from_1 > 0) address = place.sources.program().address_of(*file, static_cast<std::size_t>(from_1));
  if (!address) return mistake("there is no instruction on this line or below it");
  BreakpointRequest request;
  request.address = *address;
  return request;
}

/// A label or, in a twin, a condition on signals: "velocity > 500".
Result<BreakpointRequest> at_function(const json& wanted, const BreakpointPlace& place) {
  Result<std::string> name = required_text(wanted, "name");
  if (!name) return name.error();
  BreakpointRequest request;
  if (const std::optional<std::uint16_t> address = place.sources.program().address_of_label(*name)) {
    request.address = *address;
    return request;
  }
  debug::TwinPowers* const twin = place.engine.target().twin();
  if (twin == nullptr) return mistake("there is no label " + lang::in_quotes(*name));
  if (const auto signal = twin->signal(*name); !signal) {
    return mistake("there is no label " + lang::in_quotes(*name) + ", nor is it a condition on signals (" +
                   signal.error().message + ")");
  }
  request.kind = BreakpointRequest::Kind::signal;
  request.subject = std::move(*name);
  return request;
}

Result<BreakpointRequest> at_instruction(const json& wanted, const BreakpointPlace& place) {
  const Result<std::string> reference = required_text(wanted, "instructionReference");
  if (!reference) return reference.error();
  const Result<std::int64_t> offset = optional_integer(wanted, "offset", 0);
  if (!offset) return offset.error();
  const Result<std::uint16_t> address = address_of_reference(*reference, *offset, place.engine.program().module());
  if (!address) return address.error();
  BreakpointRequest request;
  request.address = *address;
  return request;
}

Result<BreakpointRequest> at_change(const json& wanted) {
  Result<std::string> subject = required_text(wanted, "dataId");
  if (!subject) return subject.error();
  BreakpointRequest request;
  request.kind = BreakpointRequest::Kind::change;
  request.subject = std::move(*subject);
  return request;
}

Result<BreakpointRequest> unconditional(Kind kind, const json& source, const json& wanted,
                                        const BreakpointPlace& place) {
  switch (kind) {
    case Kind::line:
      return at_line(source, wanted, place);
    case Kind::function:
      return at_function(wanted, place);
    case Kind::instruction:
      return at_instruction(wanted, place);
    case Kind::data:
      return at_change(wanted);
  }
  return mistake("unknown kind of breakpoint");
}

Result<BreakpointRequest> request_of(Kind kind, const json& source, const json& wanted, const BreakpointPlace& place) {
  Result<BreakpointRequest> request = unconditional(kind, source, wanted, place);
  if (!request) return request;
  const std::pair<const char*, std::string*> texts[] = {{"condition", &request->condition},
                                                        {"hitCondition", &request->hit_condition},
                                                        {"logMessage", &request->log_message}};
  for (const auto& [name, text] : texts) {
    Result<std::string> value = optional_text(wanted, name);
    if (!value) return value.error();
    *text = std::move(*value);
  }
  return request;
}

}  // namespace

const char* BreakpointSets::stop_reason_of(Kind kind) {
  switch (kind) {
    case Kind::line:
      return "breakpoint";
    case Kind::function:
      return "function breakpoint";
    case Kind::instruction:
      return "instruction breakpoint";
    case Kind::data:
      return "data breakpoint";
  }
  return "breakpoint";
}

Answer BreakpointSets::set(Kind kind, const json& arguments, const BreakpointPlace& place) {
  const json& wanted = member(arguments, "breakpoints");
  if (!wanted.is_null() && !wanted.is_array()) {
    return mistake(std::string("'breakpoints' must be an array, not ") + wanted.type_name());
  }
  Group group{kind, {}, wanted.is_null() ? json::array() : wanted, member(arguments, "source"), {}};
  if (kind == Kind::line) {
    const Result<std::string> path = optional_text(group.source, "path");
    if (!path) return path.error();
    const Result<std::int64_t> reference = optional_integer(group.source, "sourceReference", 0);
    if (!reference) return reference.error();
    if (path->empty() && *reference == 0) return mistake("'source' has neither 'path' nor 'sourceReference'");
    group.file = path->empty() ? std::to_string(*reference) : canonical_path(*path);
  }
  const auto former = std::find_if(groups_.begin(), groups_.end(),
                                   [&](const Group& other) { return other.kind == kind && other.file == group.file; });
  if (former != groups_.end()) {
    for (const Placed& placed : former->placed) {
      if (placed.number) place.engine.remove(*placed.number);
    }
    groups_.erase(former);
  }
  json breakpoints = json::array();
  for (const json& item : group.wanted) {
    Placed placed{++last_id_, {}};
    breakpoints.push_back(place_one(group, item, placed, place));
    group.placed.push_back(placed);
  }
  groups_.push_back(std::move(group));
  return json{{"breakpoints", std::move(breakpoints)}};
}

json BreakpointSets::place_one(const Group& group, const json& wanted, Placed& placed, const BreakpointPlace& place) {
  json breakpoint{{"id", placed.id}, {"verified", false}};
  placed.number.reset();
  if (place.only_runs) {
    breakpoint["message"] = "the program runs without debugging";
    return breakpoint;
  }
  Result<BreakpointRequest> request = request_of(group.kind, group.source, wanted, place);
  if (!request) {
    breakpoint["message"] = request.error().message;
    return breakpoint;
  }
  const BreakpointRequest::Kind kind = request->kind;
  const std::uint16_t address = request->address;
  const Result<int> number = place.engine.add(std::move(*request));
  if (!number) {
    breakpoint["message"] = number.error().message;
    return breakpoint;
  }
  placed.number = *number;
  breakpoint["verified"] = true;
  if (kind == BreakpointRequest::Kind::address) {
    place.sources.put_place(breakpoint, address, place.client);
    breakpoint["instructionReference"] = memory_reference(address);
  }
  return breakpoint;
}

std::vector<json> BreakpointSets::move_to(const BreakpointPlace& place) {
  std::vector<json> events;
  for (Group& group : groups_) {
    for (std::size_t i = 0; i < group.placed.size(); ++i) {
      json breakpoint = place_one(group, group.wanted[i], group.placed[i], place);
      events.push_back({{"reason", "changed"}, {"breakpoint", std::move(breakpoint)}});
    }
  }
  return events;
}

std::optional<BreakpointSets::Hit> BreakpointSets::find(int number) const {
  for (const Group& group : groups_) {
    for (const Placed& placed : group.placed) {
      if (placed.number == number) return Hit{placed.id, group.kind};
    }
  }
  return std::nullopt;
}

}  // namespace opentmcl::editor::dap
