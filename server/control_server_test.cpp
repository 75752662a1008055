#include "server/control_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <filesystem>
#include <functional>

#include "firmware/spec/instructions.hpp"
#include "server/memory_line.hpp"
#include "server/temporary_folder_test.hpp"

namespace opentmcl::server {
namespace {

using boost::asio::local::stream_protocol;
using nlohmann::json;
using testing::HasSubstr;

/// A client that reads only when the test lets it.
class Socket {
 public:
  /// @param pump lets the other end work
  Socket(boost::asio::io_context& events, const std::string& path, std::function<void()> pump)
      : pump_(std::move(pump)), socket_(events) {
    boost::system::error_code error;
    socket_.connect(stream_protocol::endpoint(path), error);
    EXPECT_FALSE(error) << error.message();
    socket_.non_blocking(true);
  }

  void send(std::string_view text) {
    boost::system::error_code error;
    while (!text.empty()) {
      text.remove_prefix(socket_.write_some(boost::asio::buffer(text), error));
      pump_();
      if (error && error != boost::asio::error::would_block) return;
    }
  }
  /// The next line; "closed" when the other end has closed.
  std::string line() {
    for (int i = 0; i < 100'000; ++i) {
      const std::size_t end = received_.find('\n');
      if (end != std::string::npos) {
        std::string line = received_.substr(0, end);
        received_.erase(0, end + 1);
        return line;
      }
      if (!receive()) return "closed";
    }
    return "nothing";
  }
  json response() { return json::parse(line(), nullptr, false); }
  json ask(const std::string& method, const json& params = json::object()) {
    send(json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump() + "\n");
    return response();
  }
  void close() {
    socket_.close();
    pump_();
  }

 private:
  bool receive() {
    pump_();
    std::array<char, 65536> block{};
    boost::system::error_code error;
    const std::size_t count = socket_.read_some(boost::asio::buffer(block), error);
    received_.append(block.data(), count);
    return !error || error == boost::asio::error::would_block;
  }

  std::function<void()> pump_;
  stream_protocol::socket socket_;
  std::string received_;
};

struct ControlServerTest : testing::Test {
  ControlServerTest() {
    simulation.start();
    simulation.pause();
  }

  static std::unique_ptr<Session> start(MemoryLine& line) {
    SessionSetup setup;
    setup.ports = {{hal::PortKind::usb}};
    return std::move(*Session::start(setup, {{&line.port()}, nullptr}, {}));
  }
  Socket connect() {
    return {events, path, [this] {
              events.poll();
              if (simulation.is_running_to_goal()) simulation.advance(std::chrono::steady_clock::now());
            }};
  }
  ControlServer listen() { return std::move(*ControlServer::listen(events, path, control)); }

  TemporaryFolder folder;
  std::string path = folder.path("control");
  boost::asio::io_context events;
  MemoryLine line;
  std::unique_ptr<Session> session = start(line);
  LiveSimulation simulation{events, session->module(), {&line.port()}, {}};
  Control control{*session, simulation};
};

TEST_F(ControlServerTest, AnswersManyClients) {
  const ControlServer server = listen();
  Socket first = connect();
  Socket second = connect();
  EXPECT_EQ(24.0, second.ask("get", {{"names", "supply_voltage"}})["result"]["values"]["supply_voltage"]);
  first.ask("set", {{"values", {{"supply_voltage", 12}}}});
  EXPECT_EQ(12.0, second.ask("get", {{"names", "supply_voltage"}})["result"]["values"]["supply_voltage"]);
}

TEST_F(ControlServerTest, IsForTheSameUserOnly) {
  const ControlServer server = listen();
  struct stat status {};
  ASSERT_EQ(0, ::stat(path.c_str(), &status));
  EXPECT_EQ(0600u, status.st_mode & 0777);
}

TEST_F(ControlServerTest, RemovesItsSocketAndCutsClientsOff) {
  std::optional<ControlServer> server(listen());
  Socket client = connect();
  client.ask("time");
  server.reset();
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ("closed", client.line());
}

TEST_F(ControlServerTest, ReplacesASocketThatIsLeftOver) {
  { stream_protocol::acceptor killed(events, stream_protocol::endpoint(path)); }
  ASSERT_TRUE(std::filesystem::exists(path));
  const ControlServer server = listen();
  Socket client = connect();
  EXPECT_TRUE(client.ask("time").contains("result"));
}

TEST_F(ControlServerTest, LeavesALiveOneAndOtherFilesAlone) {
  const ControlServer server = listen();
  const auto refused = ControlServer::listen(events, path, control);
  ASSERT_FALSE(refused);
  EXPECT_EQ(client::ErrorKind::input_output, refused.error().kind);
  EXPECT_THAT(refused.error().message, HasSubstr("another simulation listens there"));
  folder.write("file", "content");
  EXPECT_THAT(ControlServer::listen(events, folder.path("file"), control).error().message,
              HasSubstr("something that is not a socket"));
  EXPECT_EQ("content", folder.read("file"));
  EXPECT_EQ(client::ErrorKind::usage, ControlServer::listen(events, std::string(200, 'x'), control).error().kind);
  EXPECT_EQ(client::ErrorKind::input_output,
            ControlServer::listen(events, folder.path("missing/control"), control).error().kind);
}

TEST_F(ControlServerTest, TakesRequestsInPiecesAndSeveralAtOnce) {
  const ControlServer server = listen();
  Socket client = connect();
  const std::string request = R"({"jsonrpc":"2.0","id":1,"method":"time"})"
                              "\n";
  for (const char byte : request) client.send({&byte, 1});
  EXPECT_EQ(1, client.response()["id"]);
  client.send(request + "\r\n\n" + request);
  EXPECT_EQ(1, client.response()["id"]);
  EXPECT_EQ(1, client.response()["id"]);
}

TEST_F(ControlServerTest, AnswersMalformedRequestsAndGoesOn) {
  const ControlServer server = listen();
  Socket client = connect();
  for (const char* text : {"nonsense\n", "{\"jsonrpc\":\n", "\"\xFF\xFE\"\n"}) {
    client.send(text);
    EXPECT_EQ(-32700, client.response()["error"]["code"]) << text;
  }
  client.send("[]\n");
  EXPECT_EQ(-32600, client.response()["error"]["code"]);
  EXPECT_EQ(-32601, client.ask("jump")["error"]["code"]);
  EXPECT_EQ(-32602, client.ask("get", {{"names", 1}})["error"]["code"]);
  EXPECT_TRUE(client.ask("time").contains("result"));
}

TEST_F(ControlServerTest, CutsOffARequestWithoutEnd) {
  const ControlServer server = listen();
  Socket client = connect();
  Socket other = connect();
  client.send(std::string(ControlServer::longest_request + 10'000, 'x'));
  EXPECT_EQ(-32600, client.response()["error"]["code"]);
  EXPECT_EQ("closed", client.line());
  EXPECT_TRUE(other.ask("time").contains("result"));
}

TEST_F(ControlServerTest, CutsOffAClientThatDoesNotRead) {
  const ControlServer server = listen();
  Socket slow = connect();
  Socket other = connect();
  slow.ask("subscribe", {{"every", 20}});
  line.send(encode(Request{1, {static_cast<std::uint8_t>(Opcode::ror), 0, 0, 2000}}));
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(other.ask("step", {{"by", 100'000}}).contains("result"));
  }
  std::string last;
  std::size_t length = 0;
  while (last != "closed") {
    last = slow.line();
    length += last.size();
    ASSERT_NE("nothing", last);
  }
  EXPECT_LT(length, 2 * ControlServer::longest_backlog);
  EXPECT_TRUE(other.ask("time").contains("result"));
}

TEST_F(ControlServerTest, ForgetsAClientThatGoesInTheMiddle) {
  const ControlServer server = listen();
  Socket client = connect();
  Socket other = connect();
  client.ask("subscribe", {{"every", 1000}});
  client.send(R"({"jsonrpc":"2.0","id":1,"meth)");
  client.close();
  EXPECT_TRUE(other.ask("step", {{"by", 10'000}}).contains("result"));

  Socket impatient = connect();
  impatient.send(R"({"jsonrpc":"2.0","id":1,"method":"step","params":{"by":1000000}})"
                 "\n");
  impatient.close();
  EXPECT_TRUE(other.ask("time").contains("result"));
}

TEST_F(ControlServerTest, HasRoomForALimitedNumberOfClients) {
  const ControlServer server = listen();
  std::vector<std::unique_ptr<Socket>> clients;
  for (std::size_t i = 0; i < ControlServer::most_clients; ++i) {
    clients.push_back(std::make_unique<Socket>(connect()));
    clients.back()->ask("time");
  }
  Socket refused = connect();
  EXPECT_EQ("closed", refused.line());
  clients.front()->close();
  Socket welcome = connect();
  EXPECT_TRUE(welcome.ask("time").contains("result"));
}

}  // namespace
}  // namespace opentmcl::server
