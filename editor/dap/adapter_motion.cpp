// How the client lets the program go, and hears where it stands.

#include <utility>

#include "editor/dap/adapter.hpp"
#include "editor/dap/memory.hpp"

namespace opentmcl::editor::dap {

using client::Error;
using client::ErrorKind;
using client::Result;
using debug::Motion;
using debug::Stop;

namespace {

constexpr int thread_id = 1;

Error has_ended() {
  return mistake("the program has ended: restart it, or in a twin step back");
}

}  // namespace

Answer Adapter::threads(const json& /*arguments*/) {
  return json{{"threads", json::array({{{"id", thread_id}, {"name", "TMCL program"}}})}};
}

/// At the end, where one can still look around, it is what ends the session.
Answer Adapter::continue_program(const json& /*arguments*/) {
  if (engine_->has_ended()) {
    end_debugging();
  } else {
    next_motion_ = Motion{};
  }
  return json{{"allThreadsContinued", true}};
}

Answer Adapter::step(Motion::Kind kind) {
  if (engine_->has_ended()) return has_ended();
  next_motion_ = Motion{kind};
  return json::object();
}

Answer Adapter::next(const json& /*arguments*/) {
  return step(Motion::Kind::step_over);
}

Answer Adapter::step_in(const json& /*arguments*/) {
  return step(Motion::Kind::step);
}

Answer Adapter::step_out(const json& /*arguments*/) {
  if (engine_->frames_are_whole() && engine_->frames().size() == 1) {
    return mistake("no subroutine is open, so there is no way out");
  }
  return step(Motion::Kind::step_out);
}

/// The opposite of `next`; by instructions, that of `stepIn`.
Answer Adapter::step_back(const json& arguments) {
  const Result<std::string> granularity = optional_text(arguments, "granularity");
  if (!granularity) return granularity.error();
  const bool steps_in = *granularity == "instruction";
  next_motion_ = Motion{steps_in ? Motion::Kind::reverse_step : Motion::Kind::reverse_step_over};
  return json::object();
}

Answer Adapter::reverse_continue(const json& /*arguments*/) {
  next_motion_ = Motion{Motion::Kind::reverse_run};
  return json::object();
}

Answer Adapter::pause(const json& /*arguments*/) {
  wants_pause_ = is_moving_;
  return json::object();
}

Answer Adapter::goto_targets(const json& arguments) {
  const Result<lang::FileId> file = sources_->find(member(arguments, "source"));
  if (!file) return file.error();
  const Result<std::int64_t> line = required_integer(arguments, "line");
  if (!line) return line.error();
  const std::int64_t from_1 = client_.line_from_1(*line);
  json targets = json::array();
  const debug::Program& program = engine_->program();
  if (from_1 > 0) {
    if (const auto address = program.address_of(*file, static_cast<std::size_t>(from_1))) {
      json target{{"id", *address},
                  {"label", program.name_of(*address)},
                  {"instructionPointerReference", memory_reference(*address)}};
      sources_->put_place(target, *address, client_);
      target.erase("source");
      targets.push_back(std::move(target));
    }
  }
  return json{{"targets", std::move(targets)}};
}

Answer Adapter::go_to(const json& arguments) {
  const Result<std::int64_t> target = required_integer(arguments, "targetId");
  if (!target) return target.error();
  if (*target < 0 || *target >= static_cast<std::int64_t>(engine_->program().size())) {
    return mistake("there is no target " + std::to_string(*target));
  }
  const Result<Stop> stop = engine_->jump(static_cast<std::uint16_t>(*target));
  if (!stop) return stop.error();
  json body = stopped_body(*stop);
  body["reason"] = "goto";
  tell_afterwards("stopped", std::move(body));
  return json::object();
}

void Adapter::move(const Motion& motion) {
  has_gone_ = true;
  is_moving_ = true;
  const Result<Stop> stop = engine_->go(motion, [this](const debug::Underway&) { return look_after_messages(); });
  is_moving_ = false;
  wants_pause_ = false;
  if (!stop) {
    outbox_.say(Voice::problem, stop.error().message);
    if (stop.error().kind == ErrorKind::usage) {
      report(engine_->stop());
    } else {
      end_debugging();  // the module cannot be reached any more
    }
  } else if (stop->reason == Stop::Reason::ended && request_.without_debugging) {
    end_debugging();
  } else if (stop->reason != Stop::Reason::pause || waiting_.empty()) {
    report(*stop);
  }
  reports_entry_ = false;
  for (auto& [event, body] : std::exchange(afterwards_, {})) outbox_.tell(event, std::move(body));
}

void Adapter::report(const Stop& stop) {
  outbox_.tell("stopped", stopped_body(stop));
}

json Adapter::stopped_body(const Stop& stop) const {
  json body{{"threadId", thread_id}, {"allThreadsStopped", true}};
  if (!stop.description.empty()) body["text"] = stop.description;
  std::optional<BreakpointSets::Hit> first;
  for (const int number : stop.breakpoints) {
    const std::optional<BreakpointSets::Hit> hit = breakpoints_.find(number);
    if (!hit) continue;
    if (!first) first = hit;
    body["hitBreakpointIds"].push_back(hit->id);
  }
  switch (stop.reason) {
    case Stop::Reason::entry:
      body["reason"] = "entry";
      break;
    case Stop::Reason::step:
      body["reason"] = "step";
      break;
    case Stop::Reason::breakpoint:
    case Stop::Reason::change:
    case Stop::Reason::signal:
      body["reason"] = BreakpointSets::stop_reason_of(first ? first->kind : BreakpointSets::Kind::line);
      break;
    case Stop::Reason::trouble:
      body["reason"] = "exception";
      body["description"] = "Paused on " + stop.description;
      break;
    case Stop::Reason::pause:
    case Stop::Reason::limit:
      body["reason"] = reports_entry_ ? "entry" : "pause";
      break;
    case Stop::Reason::ended:
      body["reason"] = "ended";
      body["description"] = "The program has ended";
      break;
    case Stop::Reason::beginning:
      body["reason"] = "entry";
      body["description"] = "The begin of the program: there is nothing before it";
      break;
  }
  return body;
}

}  // namespace opentmcl::editor::dap
