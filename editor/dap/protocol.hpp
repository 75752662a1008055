// What the messages of the Debug Adapter Protocol are made of: arguments that are read without trusting them, and
// answers and events on their way out. The protocol: https://microsoft.github.io/debug-adapter-protocol/specification
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "client/error.hpp"
#include "debug/mistake.hpp"
#include "editor/message_stream.hpp"

namespace opentmcl::editor::dap {

using nlohmann::json;

/// The body of a response, or the reason why the request failed.
using Answer = client::Result<json>;

using debug::mistake;

/// The member of this name; null if there is none, or `object` is no object.
const json& member(const json& object, const char* name);

// Members of a request's arguments. Error: usage, if there is one of another type, or none where it is required.

client::Result<std::string> required_text(const json& arguments, const char* name);
/// Empty if there is none.
client::Result<std::string> optional_text(const json& arguments, const char* name);
client::Result<std::int64_t> required_integer(const json& arguments, const char* name);
client::Result<std::int64_t> optional_integer(const json& arguments, const char* name, std::int64_t otherwise);
client::Result<bool> optional_truth(const json& arguments, const char* name, bool otherwise);

/// What a client has said of itself: how it counts, and what it understands beyond the least.
struct ClientConventions {
  std::int64_t first_line = 1;
  std::int64_t first_column = 1;
  bool knows_progress = false;
  bool knows_invalidated = false;

  /// Error: usage.
  static client::Result<ClientConventions> read(const json& arguments);

  // Lines and columns as the client counts them, from those that count from 1, and back.
  std::int64_t line(std::size_t line) const { return static_cast<std::int64_t>(line) - 1 + first_line; }
  std::int64_t column(std::size_t column) const { return static_cast<std::int64_t>(column) - 1 + first_column; }
  std::int64_t line_from_1(std::int64_t line) const { return line - first_line + 1; }
};

/// Who a text in the client's console comes from.
enum class Voice : std::uint8_t {
  console,  ///< the debugger
  problem,  ///< something that is wrong
  program,  ///< the bench and the program: logpoints, a scenario
};

/// Numbers what goes to the client, and notices when nobody is there any more.
class Outbox {
 public:
  /// `stream` must outlive this.
  explicit Outbox(MessageStream& stream) : stream_(stream) {}

  void answer(const json& request, const Answer& answer);
  void tell(std::string_view event, json body = json::object());
  /// @param text gets a line end if it has none
  void say(Voice voice, std::string text);

  bool is_closed() const { return closed_; }

 private:
  void send(json message);

  MessageStream& stream_;
  std::int64_t last_number_ = 0;
  bool closed_ = false;
};

}  // namespace opentmcl::editor::dap
