// Messages, and how debugging begins and ends.

#include "editor/dap/adapter.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "editor/dap/capabilities.hpp"
#include "editor/dap/transfer_progress.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::editor::dap {

using client::Error;
using client::ErrorKind;
using client::Result;
using State = ReadOutcome::State;

namespace {

/// How long a wish of somebody else than the client can go unnoticed.
constexpr std::chrono::milliseconds look_interval{200};

}  // namespace

const Adapter::Row Adapter::rows[] = {
    {"initialize", When::always, &Adapter::initialize},
    {"launch", When::always, &Adapter::launch},
    {"attach", When::always, &Adapter::attach},
    {"disconnect", When::after_halt, &Adapter::disconnect},
    {"cancel", When::always, &Adapter::cancel},
    {"configurationDone", When::with_program, &Adapter::configuration_done},
    {"restart", When::after_halt, &Adapter::restart},
    {"terminate", When::after_halt, &Adapter::terminate},
    {"threads", When::always, &Adapter::threads},
    {"continue", When::standing, &Adapter::continue_program},
    {"next", When::standing, &Adapter::next},
    {"stepIn", When::standing, &Adapter::step_in},
    {"stepOut", When::standing, &Adapter::step_out},
    {"stepBack", When::standing, &Adapter::step_back},
    {"reverseContinue", When::standing, &Adapter::reverse_continue},
    {"pause", When::with_program, &Adapter::pause},
    {"gotoTargets", When::with_program, &Adapter::goto_targets},
    {"goto", When::standing, &Adapter::go_to},
    {"setBreakpoints", When::with_program, &Adapter::set_breakpoints},
    {"setFunctionBreakpoints", When::with_program, &Adapter::set_function_breakpoints},
    {"setInstructionBreakpoints", When::with_program, &Adapter::set_instruction_breakpoints},
    {"setDataBreakpoints", When::with_program, &Adapter::set_data_breakpoints},
    {"dataBreakpointInfo", When::with_program, &Adapter::data_breakpoint_info},
    {"setExceptionBreakpoints", When::with_program, &Adapter::set_exception_breakpoints},
    {"exceptionInfo", When::standing, &Adapter::exception_info},
    {"breakpointLocations", When::with_program, &Adapter::breakpoint_locations},
    {"stackTrace", When::standing, &Adapter::stack_trace},
    {"scopes", When::with_program, &Adapter::scopes},
    {"variables", When::with_program, &Adapter::variables},
    {"setVariable", When::with_program, &Adapter::set_variable},
    {"setExpression", When::with_program, &Adapter::set_expression},
    {"evaluate", When::with_program, &Adapter::evaluate},
    {"source", When::with_program, &Adapter::source},
    {"loadedSources", When::with_program, &Adapter::loaded_sources},
    {"readMemory", When::with_program, &Adapter::read_memory_request},
    {"disassemble", When::with_program, &Adapter::disassemble_request},
};

Adapter::Adapter(MessageStream& stream, OpenSession open_session, Interrupted interrupted)
    : stream_(stream),
      outbox_(stream),
      open_session_(std::move(open_session)),
      interrupted_(interrupted ? std::move(interrupted) : [] { return false; }) {}

// ---- Messages

Result<void> Adapter::run() {
  while (!is_over_) work(look_interval);
  if (stream_error_.empty()) return {};
  return Error{ErrorKind::protocol, stream_error_, {}};
}

bool Adapter::work(MessageStream::Limit limit) {
  if (is_over_) return false;
  bool has_worked = true;
  if (!waiting_.empty()) {
    const json request = std::move(waiting_.front());
    waiting_.pop_front();
    handle(request);
  } else if (next_motion_) {
    move(*std::exchange(next_motion_, std::nullopt));
  } else {
    ReadOutcome outcome = stream_.read(limit);
    has_worked = outcome.state != State::nothing_yet;
    take(std::move(outcome));
  }
  is_over_ = is_over_ || outbox_.is_closed() || interrupted_();
  if (is_over_) leave();
  return has_worked;
}

void Adapter::take(ReadOutcome outcome) {
  switch (outcome.state) {
    case State::message:
      return handle(outcome.message);
    case State::nothing_yet:
      return;
    case State::not_json:
      return outbox_.say(Voice::problem, outcome.error);
    case State::closed:
      is_over_ = true;
      return;
    case State::broken:
      stream_error_ = std::move(outcome.error);
      is_over_ = true;
      return;
  }
}

void Adapter::handle(const json& request) {
  // What is no request needs no answer: this adapter asks the client nothing.
  const json& type = member(request, "type");
  if (type == "response" || type == "event") return;
  if (type != "request") return outbox_.answer(request, mistake("a message must have the type 'request'"));
  const json& command = member(request, "command");
  if (!command.is_string()) return outbox_.answer(request, mistake("a request must have a 'command', a string"));
  const auto row = std::find_if(std::begin(rows), std::end(rows), [&](const Row& other) {
    return other.command == command.get_ref<const std::string&>();
  });
  if (row == std::end(rows)) {
    return outbox_.answer(request,
                          mistake("unknown request " + lang::in_quotes(command.get_ref<const std::string&>())));
  }
  if (!is_initialized_ && row->handle != &Adapter::initialize && row->handle != &Adapter::disconnect) {
    return outbox_.answer(request, mistake("the first request must be 'initialize'"));
  }
  if (is_moving_ && row->when == When::after_halt) {
    waiting_.push_back(request);
    return;
  }
  answer(request, *row);
}

void Adapter::answer(const json& request, const Row& row) {
  if (row.when == When::standing && is_moving_) {
    return outbox_.answer(request, mistake("the program runs; pause it first"));
  }
  const bool needs_program = row.when == When::with_program || row.when == When::standing;
  if (needs_program && !engine_) {
    return outbox_.answer(request, mistake("nothing is debugged: it begins with 'launch' or 'attach'"));
  }
  current_ = &request;
  const Answer answer = (this->*row.handle)(member(request, "arguments"));
  current_ = nullptr;
  outbox_.answer(request, answer);
  for (auto& [event, body] : std::exchange(afterwards_, {})) outbox_.tell(event, std::move(body));
}

void Adapter::tell_afterwards(std::string event, json body) {
  afterwards_.emplace_back(std::move(event), std::move(body));
}

/// @return whether the program may go on
bool Adapter::look_after_messages() {
  while (!is_over_) {
    ReadOutcome outcome = stream_.read(std::chrono::milliseconds(0));
    if (outcome.state == State::nothing_yet) break;
    take(std::move(outcome));
  }
  return !is_over_ && !wants_pause_ && waiting_.empty() && !outbox_.is_closed() && !interrupted_();
}

/// Messages that come meanwhile have to wait, but some of them end the transfer.
client::Progress Adapter::progress_with_title(const char* title) {
  auto progress =
      std::make_shared<TransferProgress>(outbox_, client_, "transfer" + std::to_string(++last_progress_), title);
  const json number = current_ != nullptr ? member(*current_, "seq") : json();
  return [this, progress, number](std::size_t done, std::size_t total) {
    progress->show(done, total);
    bool goes_on = !outbox_.is_closed() && !interrupted_();
    while (goes_on && !is_over_) {
      ReadOutcome outcome = stream_.read(std::chrono::milliseconds(0));
      if (outcome.state == State::nothing_yet) break;
      if (outcome.state != State::message) {
        take(std::move(outcome));
        continue;
      }
      const json& message = waiting_.emplace_back(std::move(outcome.message));
      const json& command = member(message, "command");
      const json& arguments = member(message, "arguments");
      const bool is_cancelled = command == "cancel" && (member(arguments, "progressId") == progress->id() ||
                                                        member(arguments, "requestId") == number);
      goes_on = !is_cancelled && command != "disconnect" && command != "terminate";
    }
    return goes_on && !is_over_;
  };
}

// ---- Beginning and end

Answer Adapter::initialize(const json& arguments) {
  if (is_initialized_) return mistake("the adapter is initialized already");
  const Result<ClientConventions> client = ClientConventions::read(arguments);
  if (!client) return client.error();
  client_ = *client;
  is_initialized_ = true;
  return capabilities();
}

Answer Adapter::launch(const json& arguments) {
  const Result<SessionRequest> request = SessionRequest::read(arguments, false);
  if (!request) return request.error();
  return begin(*request);
}

Answer Adapter::attach(const json& arguments) {
  const Result<SessionRequest> request = SessionRequest::read(arguments, true);
  if (!request) return request.error();
  return begin(*request);
}

Answer Adapter::begin(SessionRequest request) {
  if (engine_) return mistake("a program is debugged already: 'disconnect' comes first");
  if (Result<void> opened = open(request); !opened) return opened.error();
  request_ = std::move(request);
  has_gone_ = engine_->is_running();
  if (engine_->target().twin() != nullptr) tell_afterwards("capabilities", capabilities_of_twins());
  const debug::Program& program = engine_->program();
  tell_afterwards("process",
                  {{"name", program.file_name(0)}, {"startMethod", request_.attaches ? "attach" : "launch"}});
  tell_afterwards("initialized");
  return json::object();
}

Result<void> Adapter::open(const SessionRequest& request) {
  const Say say = [this](Voice voice, const std::string& text) { outbox_.say(voice, text); };
  Result<std::unique_ptr<Session>> session = open_session_(request, say, progress_with_title("Reading the program"));
  if (!session) return session.error();
  session_ = std::move(*session);
  engine_ = std::make_unique<debug::Engine>(session_->target(), session_->take_program(),
                                            [this](const std::string& text) { outbox_.say(Voice::program, text); });
  sources_.emplace(engine_->program());
  const Result<std::string> loaded = session_->load(*engine_, progress_with_title("Loading the program"));
  if (!loaded) {
    close();
    return loaded.error();
  }
  outbox_.say(Voice::console, *loaded);
  return {};
}

void Adapter::close() {
  sources_.reset();
  engine_.reset();
  session_.reset();
}

Answer Adapter::configuration_done(const json& /*arguments*/) {
  stand_or_run();
  return json::object();
}

void Adapter::stand_or_run() {
  reports_entry_ = request_.stops_on_entry && !request_.without_debugging;
  const bool runs_already = engine_->is_running();
  if (!runs_already && (reports_entry_ || request_.attaches)) {
    reports_entry_ = false;
    return tell_afterwards("stopped", stopped_body(engine_->stop()));
  }
  wants_pause_ = reports_entry_;
  next_motion_ = debug::Motion{};
}

/// What does not change in a session, such as its port, stays as it was launched.
Answer Adapter::restart(const json& arguments) {
  if (!engine_) return mistake("nothing is debugged: it begins with 'launch' or 'attach'");
  const Result<bool> stops = optional_truth(member(arguments, "arguments"), "stopOnEntry", request_.stops_on_entry);
  if (!stops) return stops.error();
  request_.stops_on_entry = *stops;
  if (request_.attaches) {
    const Result<debug::Stop> stop = engine_->restart();
    if (!stop) return stop.error();
  } else {
    close();
    if (Result<void> opened = open(request_); !opened) {
      end_debugging();
      return opened.error();
    }
    engine_->stop_at_troubles(troubles_);
    for (json& event : breakpoints_.move_to(breakpoint_place())) tell_afterwards("breakpoint", std::move(event));
  }
  has_ended_ = false;
  stand_or_run();
  return json::object();
}

void Adapter::end_debugging() {
  if (std::exchange(has_ended_, true)) return;
  tell_afterwards("exited", {{"exitCode", 0}});
  tell_afterwards("terminated");
}

Answer Adapter::terminate(const json& /*arguments*/) {
  if (engine_) {
    if (const Result<void> stopped = engine_->stop_all(); !stopped) return stopped.error();
  }
  end_debugging();
  return json::object();
}

Answer Adapter::disconnect(const json& arguments) {
  const Result<bool> terminates = optional_truth(arguments, "terminateDebuggee", !request_.attaches);
  if (!terminates) return terminates.error();
  const Result<bool> suspends = optional_truth(arguments, "suspendDebuggee", false);
  if (!suspends) return suspends.error();
  is_over_ = true;
  if (!engine_) return json::object();
  Result<void> left;
  if (*terminates) {
    left = engine_->stop_all();
  } else if (!*suspends && has_gone_ && !engine_->is_running()) {
    left = engine_->detach();
  }
  close();
  if (!left) return left.error();
  return json::object();
}

/// When nobody has disconnected, somebody has crashed: the safe thing is a module that stands.
void Adapter::leave() {
  if (engine_) {
    const Result<void> stopped = engine_->stop_all();
    if (!stopped.ok() && stream_error_.empty()) stream_error_ = stopped.error().message;
  }
  close();
}

Answer Adapter::cancel(const json& /*arguments*/) {
  return json::object();
}

}  // namespace opentmcl::editor::dap
