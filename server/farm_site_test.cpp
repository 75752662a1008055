// A whole farm with its doors, and hosts in the same thread.
#include "server/farm_site.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "client/file_descriptor.hpp"
#include "client/serial_transport.hpp"
#include "client/tcp_transport.hpp"
#include "firmware/spec/instructions.hpp"
#include "server/farm_file.hpp"

namespace opentmcl::server {
namespace {

namespace fs = std::filesystem;
using client::Transport;

constexpr Request get_position(std::uint8_t address) {
  return {address, {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0}};
}

struct FarmSiteTest : testing::Test {
  FarmSiteTest() {
    std::string pattern = (fs::temp_directory_path() / "farm_site_test.XXXXXX").string();
    folder = ::mkdtemp(pattern.data());
  }
  ~FarmSiteTest() override {
    site.reset();
    fs::remove_all(folder);
  }

  /// @param text of a farm file in the test's folder
  void build(std::string_view text, double speed = 1) {
    FarmFile file = read_farm(text, (folder / "farm.toml").string());
    ASSERT_TRUE(file.problems.empty()) << file.problems.front();
    auto built =
        FarmSite::build(events, file.description,
                        [this](const FarmModule&) -> const std::vector<Command>& { return program; }, {.speed = speed});
    ASSERT_TRUE(built.ok()) << built.error().message;
    site = std::move(*built);
    site->farm().start();
  }
  const OpenDoors& doors_of(std::string_view name) {
    for (const FarmSite::Place& place : site->places()) {
      if (*place.name == name) return *place.doors;
    }
    throw std::out_of_range(std::string(name));
  }
  unsigned tcp_port_of(std::string_view name) {
    const std::string url = doors_of(name).tcp_url();
    return static_cast<unsigned>(std::stoul(url.substr(url.rfind(':') + 1)));
  }
  std::unique_ptr<Transport> connect(std::string_view name) {
    auto host = client::connect_tcp("127.0.0.1", tcp_port_of(name), std::chrono::seconds(10));
    EXPECT_TRUE(host.ok());
    return std::move(*host);
  }
  std::unique_ptr<Transport> open(const std::string& path) {
    auto host = client::open_serial(path);
    EXPECT_TRUE(host.ok());
    return std::move(*host);
  }

  void turn() {
    events.poll();
    site->farm().advance(std::chrono::steady_clock::now());
  }
  /// Runs the farm until `condition` holds, or for ten seconds. @return whether it held
  template <class Condition>
  bool run_until(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      turn();
    }
    return true;
  }
  std::string hear(Transport& host, std::size_t length) {
    std::string heard;
    run_until([&] {
      std::uint8_t buffer[64];
      const auto count = host.receive(std::span(buffer).first(std::min(sizeof buffer, length - heard.size())), {});
      if (count.ok()) heard.append(buffer, buffer + *count);
      return heard.size() == length;
    });
    return heard;
  }
  Reply ask(Transport& host, const Request& request) {
    EXPECT_TRUE(host.send(encode(request).bytes).ok());
    const std::string heard = hear(host, datagram_size);
    EXPECT_EQ(datagram_size, heard.size());
    Datagram reply{};
    std::copy(heard.begin(), heard.end(), reply.bytes);
    EXPECT_TRUE(reply.checksum_is_right());
    return decode_reply(reply);
  }

  fs::path folder;
  std::vector<Command> program;
  boost::asio::io_context events;
  std::unique_ptr<FarmSite> site;
};

TEST_F(FarmSiteTest, OpensEachModulesDoors) {
  build(R"(
[[module]]
name = "axis"
count = 2
link = "run/{name}"
tcp = 0
)");
  for (const char* name : {"axis-1", "axis-2"}) {
    EXPECT_EQ((folder / "run" / name).string(), doors_of(name).link());
    EXPECT_EQ(Status::ok, ask(*open(doors_of(name).link()), get_position(1)).status);
    EXPECT_EQ(Status::ok, ask(*connect(name), get_position(1)).status);
  }
  site.reset();
  EXPECT_TRUE(fs::is_empty(folder / "run")) << "links go with the farm";
}

TEST_F(FarmSiteTest, HasModulesWithAddressesOnOneLine) {
  build(R"(
[[rs485]]
name = "line"
link = "line"
tcp = 0
baud_rate = 115200

[[module]]
name = "first"
rs485 = "line"
address = 1
tcp = 0

[[module]]
name = "second"
kind = "tmcm1110"
rs485 = "line"
address = 5
)");
  const auto serial = open(doors_of("line").link());
  const auto tcp = connect("line");
  for (const std::uint8_t address : {std::uint8_t{1}, std::uint8_t{5}}) {
    EXPECT_EQ(address, ask(*serial, get_position(address)).module_address);
    EXPECT_EQ(address, ask(*tcp, get_position(address)).module_address);
  }
  const auto direct = connect("first");
  EXPECT_EQ(Status::ok, ask(*direct, {1, {static_cast<std::uint8_t>(Opcode::sgp), 7, 2, 4711}}).status);
  EXPECT_EQ(4711, ask(*serial, {1, {static_cast<std::uint8_t>(Opcode::ggp), 7, 2, 0}}).value);
}

TEST_F(FarmSiteTest, HasModulesWithIdentifiersOnOneCanBus) {
  build(R"(
[[can]]
name = "bus"
slcan_link = "can"
bit_rate = 250000

[[module]]
name = "arm"
kind = "tmcm1110"
count = 2
can = "bus"
address = 5
)");
  const auto adapter = open(doors_of("bus").slcan_link());
  const auto type = [&](std::string_view text) {
    EXPECT_TRUE(adapter->send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}).ok());
  };
  type("S5\rO\r");  // 250 kbit/s
  EXPECT_EQ("\r\r", hear(*adapter, 2));
  type("t005706010000000000\r");
  EXPECT_EQ("z\rt002705640600000000\r", hear(*adapter, 22));
  type("t006706010000000000\r");
  EXPECT_EQ("z\rt002706640600000000\r", hear(*adapter, 22));
}

TEST_F(FarmSiteTest, LoadsProgramsAndKeepsEeproms) {
  program = {{static_cast<std::uint8_t>(Opcode::sgp), 9, 2, 99}, {static_cast<std::uint8_t>(Opcode::stop), 0, 0, 0}};
  std::ofstream((folder / "nine.tmc").string()) << "SGP 9, 2, 99\nSTOP\n";
  const char* const text = R"(
[[module]]
name = "one"
tcp = 0
program = "nine.tmc"
eeprom = "one.eeprom"
)";
  constexpr auto ggp = static_cast<std::uint8_t>(Opcode::ggp);
  build(text);
  {
    const auto host = connect("one");
    EXPECT_TRUE(run_until([&] { return ask(*host, {1, {ggp, 9, 2, 0}}).value == 99; }));
    EXPECT_EQ(Status::ok, ask(*host, {1, {static_cast<std::uint8_t>(Opcode::sgp), 66, 0, 7}}).status);
  }
  EXPECT_TRUE(site->finish().ok());
  site.reset();
  build(text);
  EXPECT_EQ(7, ask(*connect("one"), {1, {ggp, 66, 0, 0}}).value);
}

TEST_F(FarmSiteTest, GivesEachModuleItsBench) {
  build(R"(
[[module]]
name = "loaded"
count = 2
tcp = 0
load = { torque = "0.1 Nm" }
initial = { supply_voltage = "20 V" }

[[module]]
name = "ideal"
tcp = 0
motor = "ideal"
)");
  for (const std::size_t index : {0U, 1U}) {
    const twin::World& world = site->module(index).world();
    ASSERT_TRUE(world.motor().has_value());
    EXPECT_EQ(world.motor()->motor(), twin::motors().front());
    EXPECT_EQ(world.load().torque, 0.1);
    EXPECT_EQ(world.supply_voltage(), 20'000);
  }
  EXPECT_FALSE(site->module(2).world().motor().has_value());
}

TEST_F(FarmSiteTest, NamesTheModuleThatCannotBeBuilt) {
  fs::create_directory(folder / "taken");
  const FarmFile file = read_farm("[[module]]\nname = \"pump\"\nlink = \"taken\"\n", (folder / "farm.toml").string());
  const auto built = FarmSite::build(events, file.description,
                                     [this](const FarmModule&) -> const std::vector<Command>& { return program; }, {});
  ASSERT_FALSE(built.ok());
  EXPECT_EQ(0u, built.error().message.find("pump: cannot make the link"));
}

/// A host that writes as much as it can and reads nothing.
class RudeHost {
 public:
  explicit RudeHost(unsigned port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int result = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    EXPECT_TRUE(result == 0 || errno == EINPROGRESS);
  }
  /// @return whether the operating system took some of it
  bool write_some() {
    const ssize_t count = ::send(socket_.get(), requests_.data(), requests_.size(), MSG_NOSIGNAL);
    if (count > 0) sent_ += static_cast<std::size_t>(count);
    return count > 0;
  }
  std::size_t sent() const { return sent_; }

 private:
  static std::string many_requests() {
    const Datagram request = encode(get_position(1));
    std::string text;
    for (int i = 0; i < 1000; ++i) text.append(request.bytes, request.bytes + datagram_size);
    return text;
  }

  client::FileDescriptor socket_;
  const std::string requests_ = many_requests();
  std::size_t sent_ = 0;
};

TEST_F(FarmSiteTest, IsNotDisturbedByAHostThatFloodsItsModuleAndReadsNothing) {
  build("[[module]]\nname = \"axis\"\ncount = 2\ntcp = 0\n");
  RudeHost rude(tcp_port_of("axis-1"));
  const auto other = connect("axis-2");
  int refused = 0;
  // Once it has to wait for long it will wait for ever: nobody takes the replies.
  ASSERT_TRUE(run_until([&] {
    refused = rude.write_some() ? 0 : refused + 1;
    return refused > 20'000;
  }));
  EXPECT_GT(rude.sent(), 0u);
  for (int i = 0; i < 100; ++i) {
    rude.write_some();
    EXPECT_EQ(Status::ok, ask(*other, get_position(1)).status);
  }
}

TEST_F(FarmSiteTest, PacesTheWireOfAModule) {
  build("[[module]]\nname = \"slow\"\ntcp = 0\nwire = 9600\n");
  const auto host = connect("slow");
  ask(*host, get_position(1));
  const Microseconds before = site->module(0).now();
  for (int i = 0; i < 4; ++i) ask(*host, get_position(1));
  EXPECT_GE(site->module(0).now() - before, 4 * 18'750u);
}

}  // namespace
}  // namespace opentmcl::server
