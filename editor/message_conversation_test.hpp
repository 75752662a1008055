// For tests: conversations with a server as files, a message a line. What the client says begins with "client: ", what
// the server has to say with "server: ", in which "*" stands for any value; "file: " adds a file to those that the
// server finds, "exit: " expects its exit code, "#" begins a comment.
#pragma once

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace opentmcl::editor {

/// What the files talk to.
class ConversationPartner {
 public:
  virtual ~ConversationPartner() = default;

  /// @param message JSON, as the file has it
  /// @return what is said to it
  virtual std::vector<nlohmann::json> answers_to(const std::string& message) = 0;
  virtual void add_file(const nlohmann::json& file) = 0;
  /// -1: still there
  virtual int exit_code() const { return -1; }

 protected:
  ConversationPartner() = default;
  ConversationPartner(const ConversationPartner&) = default;
  ConversationPartner& operator=(const ConversationPartner&) = default;
};

/// JSON of a conversation; reports to GoogleTest if it is none.
nlohmann::json parsed_message(const std::string& text);

/// Names of the files in a folder that end with ".conversation", in alphabetical order.
std::vector<std::string> conversations_in(const std::string& folder);

/// Holds the conversation; reports to GoogleTest what the partner says differently from the file.
void replay(const std::string& path, ConversationPartner& partner);

/// Writes what the partner says now into the file.
void record(const std::string& path, ConversationPartner& partner);

/// Replays the conversation `name` of a folder; records it before if OPENTMCL_RECORD is in the environment.
template <class Partner>
void expect_as_written(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name + ".conversation";
  if (std::getenv("OPENTMCL_RECORD") != nullptr) {
    Partner recorded;
    record(path, recorded);
  }
  Partner partner;
  replay(path, partner);
}

}  // namespace opentmcl::editor
