// The debug adapter: the Debug Adapter Protocol on one side, debug::Engine on the other.
//
// Everything happens in one thread. A request is answered before the program moves; while it moves, the engine asks
// every few milliseconds whether to go on, and the adapter looks after its messages there. Requests that need a program
// that stands wait in a queue and make it stop.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "debug/engine.hpp"
#include "editor/dap/breakpoint_sets.hpp"
#include "editor/dap/program_sources.hpp"
#include "editor/dap/protocol.hpp"
#include "editor/dap/session.hpp"
#include "editor/message_stream.hpp"

namespace opentmcl::editor::dap {

class Adapter {
 public:
  /// Whether somebody wants the adapter itself to end, by a signal.
  using Interrupted = std::function<bool()>;

  /// `stream` must outlive this.
  Adapter(MessageStream& stream, OpenSession open_session, Interrupted interrupted = {});

  /// Serves the client until it disconnects. One that goes without a word leaves a module whose program and motor are
  /// stopped. Error: protocol, when the stream cannot be understood any more.
  client::Result<void> run();

  /// Does what is to be done now: lets the program go, or waits so long for a message and handles it.
  /// @return whether there was something to do
  bool work(MessageStream::Limit limit);
  bool is_over() const { return is_over_; }

 private:
  /// When a request can be handled.
  enum class When : std::uint8_t {
    always,
    with_program,  ///< after a launch or an attach, whether the program runs or stands
    standing,      ///< refused while the program runs
    after_halt,    ///< makes it stand
  };
  struct Row {
    std::string_view command;
    When when;
    Answer (Adapter::*handle)(const json& arguments);
  };
  static const Row rows[];

  // ---- Messages
  void take(ReadOutcome outcome);
  void handle(const json& request);
  void answer(const json& request, const Row& row);
  bool look_after_messages();
  /// To be sent behind the answer.
  void tell_afterwards(std::string event, json body = json::object());
  client::Progress progress_with_title(const char* title);

  // ---- Beginning and end: adapter.cpp
  Answer initialize(const json& arguments);
  Answer launch(const json& arguments);
  Answer attach(const json& arguments);
  Answer configuration_done(const json& arguments);
  Answer restart(const json& arguments);
  Answer terminate(const json& arguments);
  Answer disconnect(const json& arguments);
  Answer cancel(const json& arguments);
  Answer begin(SessionRequest request);
  client::Result<void> open(const SessionRequest& request);
  void close();
  void stand_or_run();
  void end_debugging();
  void leave();

  // ---- The program moves: adapter_motion.cpp
  Answer threads(const json& arguments);
  Answer continue_program(const json& arguments);
  Answer next(const json& arguments);
  Answer step_in(const json& arguments);
  Answer step_out(const json& arguments);
  Answer step_back(const json& arguments);
  Answer reverse_continue(const json& arguments);
  Answer pause(const json& arguments);
  Answer goto_targets(const json& arguments);
  Answer go_to(const json& arguments);
  Answer step(debug::Motion::Kind kind);
  void move(const debug::Motion& motion);
  void report(const debug::Stop& stop);
  json stopped_body(const debug::Stop& stop) const;

  // ---- Breakpoints: adapter_breakpoints.cpp
  Answer set_breakpoints(const json& arguments);
  Answer set_function_breakpoints(const json& arguments);
  Answer set_instruction_breakpoints(const json& arguments);
  Answer set_data_breakpoints(const json& arguments);
  Answer data_breakpoint_info(const json& arguments);
  Answer set_exception_breakpoints(const json& arguments);
  Answer exception_info(const json& arguments);
  Answer breakpoint_locations(const json& arguments);
  BreakpointPlace breakpoint_place() { return {*engine_, *sources_, client_, request_.without_debugging}; }

  // ---- Looking and changing: adapter_values.cpp
  Answer stack_trace(const json& arguments);
  Answer scopes(const json& arguments);
  Answer variables(const json& arguments);
  Answer set_variable(const json& arguments);
  Answer set_expression(const json& arguments);
  Answer evaluate(const json& arguments);
  Answer source(const json& arguments);
  Answer loaded_sources(const json& arguments);
  Answer read_memory_request(const json& arguments);
  Answer disassemble_request(const json& arguments);
  void tell_of_change();

  MessageStream& stream_;
  Outbox outbox_;
  OpenSession open_session_;
  Interrupted interrupted_;
  ClientConventions client_;
  bool is_initialized_ = false;
  bool is_over_ = false;
  std::string stream_error_;

  // What is debugged: the engine uses the session and is used by the sources' program.
  SessionRequest request_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<debug::Engine> engine_;
  std::optional<ProgramSources> sources_;
  BreakpointSets breakpoints_;
  std::uint8_t troubles_ = 0;
  bool has_gone_ = false;   ///< the program was found running, or was let go
  bool has_ended_ = false;  ///< the client was told so

  std::optional<debug::Motion> next_motion_;
  bool is_moving_ = false;
  bool wants_pause_ = false;
  bool reports_entry_ = false;  ///< the next stop is the one on entry
  std::deque<json> waiting_;    ///< requests that came at the wrong time
  std::vector<std::pair<std::string, json>> afterwards_;
  const json* current_ = nullptr;  ///< the request that is being handled
  std::int64_t last_progress_ = 0;
};

}  // namespace opentmcl::editor::dap
