// For tests: an adapter that debugs twins, and the client at the other end of its stream.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "debug/twin/twin_target.hpp"
#include "editor/dap/adapter.hpp"
#include "editor/message_stream.hpp"
#include "lang/assembler.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::editor::dap {

/// A twin, and a source of the disk.
class TwinSession final : public Session {
 public:
  explicit TwinSession(debug::Program program) : twin_({}), program_(std::move(program)) {}

  static client::Result<std::unique_ptr<Session>> open(const SessionRequest& request, const Say& say,
                                                       const client::Progress& /*progress*/) {
    std::ifstream file(request.program, std::ios::binary);
    if (!file) return client::Error{client::ErrorKind::bad_file, "cannot read " + request.program, {}};
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    lang::DiskFiles files;
    lang::AssemblyResult result = lang::assemble(request.program, std::move(text), {}, files);
    for (const lang::Diagnostic& diagnostic : result.diagnostics) say(Voice::problem, diagnostic.message);
    if (!result.program) return client::Error{client::ErrorKind::bad_file, request.program + " has errors", {}};
    std::unique_ptr<Session> session = std::make_unique<TwinSession>(debug::Program(std::move(result), pd1161));
    return session;
  }

  debug::Target& target() override { return twin_; }
  debug::Program take_program() override { return std::move(program_); }
  client::Result<std::string> load(debug::Engine& engine, const client::Progress& progress) override {
    const client::Result<debug::MemoryComparison> comparison = engine.compare(progress);
    if (!comparison) return comparison.error();
    const client::Result<std::size_t> sent = engine.download(*comparison, progress);
    if (!sent) return sent.error();
    const client::Result<debug::Stop> stop = engine.restart();
    if (!stop) return stop.error();
    return "sent " + std::to_string(*sent) + " instructions";
  }

 private:
  debug::TwinTarget twin_;
  debug::Program program_;
};

/// A folder that is gone with the test.
class TestFolder {
 public:
  TestFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "tmcl_dap_test.XXXXXX").string();
    path_ = ::mkdtemp(path.data());
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    std::error_code cannot;
    std::filesystem::remove_all(path_, cannot);
  }

  const std::string& path() const { return path_; }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ + "/" + name, std::ios::binary) << text;
    return path_ + "/" + name;
  }

 private:
  std::string path_;
};

class DebuggingClient {
 public:
  explicit DebuggingClient(OpenSession open_session = TwinSession::open)
      : DebuggingClient(MemoryStream::make_pair(), std::move(open_session)) {}

  Adapter& adapter() { return adapter_; }
  MemoryStream& stream() { return *client_; }
  /// Goes without a word.
  void vanish() { client_.reset(); }

  /// Puts a request into the stream; nobody reads it yet.
  void put(const std::string& command, json arguments = json::object()) {
    client_->write(
        {{"seq", ++last_number_}, {"type", "request"}, {"command", command}, {"arguments", std::move(arguments)}});
  }
  /// Lets the adapter do all there is to do. @return what it said
  std::vector<json> listen() {
    while (adapter_.work(MessageStream::Limit(0))) continue;
    std::vector<json> said;
    while (client_ && client_->has_message()) said.push_back(client_->read({}).message);
    return said;
  }
  std::vector<json> ask(const std::string& command, json arguments = json::object()) {
    put(command, std::move(arguments));
    return listen();
  }

 private:
  DebuggingClient(std::pair<std::unique_ptr<MemoryStream>, std::unique_ptr<MemoryStream>> ends,
                  OpenSession open_session)
      : client_(std::move(ends.first)), server_(std::move(ends.second)), adapter_(*server_, std::move(open_session)) {}

  std::unique_ptr<MemoryStream> client_;
  std::unique_ptr<MemoryStream> server_;
  Adapter adapter_;
  std::int64_t last_number_ = 0;
};

}  // namespace opentmcl::editor::dap
