// A farm under load: `tmcl farm` with many modules, each with its TCP port and its host, which asks now and then.
// Prints what the farm takes of a processor and of memory, and how long replies take.
//
// usage: farm_load path/to/tmcl [modules] [commands per second, of all] [seconds] [velocity: internal units, 0 at rest]

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "client/file_descriptor.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using opentmcl::AxisParameter;
using opentmcl::datagram_size;
using opentmcl::Opcode;
using opentmcl::client::FileDescriptor;

void check(bool good, const std::string& what) {
  if (!good) throw std::runtime_error(what + ": " + std::strerror(errno));
}

struct Load {
  const char* program;
  std::size_t modules = 2000;
  double commands_per_second = 2000;
  double seconds = 10;
  std::int32_t velocity = 500;  ///< internal units; 0: at rest
};

/// `tmcl farm` as a child process that ends with this, and what it says of its doors.
class FarmProcess {
 public:
  FarmProcess(const Load& load, const std::string& folder) {
    const std::string file = folder + "/farm.toml";
    // A free shaft: none comes to the end of a stage.
    std::ofstream(file) << "[[module]]\nname = \"m\"\ncount = " << load.modules << "\ntcp = 0\nmachine = \"free\"\n";
    int ends[2];
    check(::pipe(ends) == 0, "pipe");
    process_ = ::fork();
    check(process_ >= 0, "fork");
    if (process_ == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::execl(load.program, load.program, "--json", "farm", "--quiet", file.c_str(), nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    const FileDescriptor output(ends[0]);
    std::string text;
    char buffer[4096];
    while (text.empty() || text.back() != '\n') {
      const ssize_t count = ::read(output.get(), buffer, sizeof buffer);
      check(count > 0, "tmcl farm did not start");
      text.append(buffer, static_cast<std::size_t>(count));
    }
    const nlohmann::json places = nlohmann::json::parse(text);
    for (const auto& module : places.at("modules")) {
      const std::string url = module.at("tcp");
      ports_.push_back(static_cast<std::uint16_t>(std::stoul(url.substr(url.rfind(':') + 1))));
    }
  }
  FarmProcess(const FarmProcess&) = delete;
  FarmProcess& operator=(const FarmProcess&) = delete;
  ~FarmProcess() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }

  const std::vector<std::uint16_t>& ports() const { return ports_; }

  /// Seconds of a processor it has used so far.
  double processor_time() const {
    std::ifstream file("/proc/" + std::to_string(process_) + "/stat");
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    // Behind the name in parentheses: state, then 10 numbers, then user and system time.
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string field;
    double user = 0;
    double system = 0;
    for (int i = 0; i < 11; ++i) fields >> field;
    fields >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  }

  /// Memory it has in use, MiB.
  double memory() const {
    std::ifstream file("/proc/" + std::to_string(process_) + "/statm");
    double size = 0;
    double resident = 0;
    file >> size >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024 * 1024);
  }

 private:
  pid_t process_ = -1;
  std::vector<std::uint16_t> ports_;
};

class Host {
 public:
  explicit Host(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    check(socket_.is_open(), "socket");
    check(::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0, "connect");
    const int yes = 1;
    ::setsockopt(socket_.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  }

  int socket() const { return socket_.get(); }
  bool is_waiting() const { return is_waiting_; }

  void ask(Opcode opcode, AxisParameter parameter, std::int32_t value) {
    const opentmcl::Datagram request = encode(
        opentmcl::Request{1, {static_cast<std::uint8_t>(opcode), static_cast<std::uint8_t>(parameter), 0, value}});
    is_waiting_ = true;
    received_ = 0;
    asked_ = Clock::now();
    check(::send(socket_.get(), request.bytes, datagram_size, MSG_NOSIGNAL) == ssize_t{datagram_size}, "send");
  }

  /// @return whether the reply is complete
  bool hear() {
    unsigned char buffer[datagram_size];
    const ssize_t count = ::recv(socket_.get(), buffer, sizeof buffer, 0);
    check(count > 0, "recv");
    received_ += static_cast<std::size_t>(count);
    if (received_ < datagram_size) return false;
    is_waiting_ = false;
    return true;
  }
  double microseconds_since_asked() const {
    return std::chrono::duration<double, std::micro>(Clock::now() - asked_).count();
  }

 private:
  FileDescriptor socket_;
  bool is_waiting_ = false;
  std::size_t received_ = 0;
  Clock::time_point asked_{};
};

/// All hosts, in one thread.
class Hosts {
 public:
  explicit Hosts(const std::vector<std::uint16_t>& ports) : events_(::epoll_create1(EPOLL_CLOEXEC)) {
    hosts_.reserve(ports.size());
    for (const std::uint16_t port : ports) {
      Host& host = hosts_.emplace_back(port);
      epoll_event event{};
      event.events = EPOLLIN;
      event.data.ptr = &host;
      check(::epoll_ctl(events_.get(), EPOLL_CTL_ADD, host.socket(), &event) == 0, "epoll_ctl");
    }
  }

  void ask_all(Opcode opcode, std::int32_t value) {
    for (Host& host : hosts_) host.ask(opcode, AxisParameter{}, value);
    while (std::any_of(hosts_.begin(), hosts_.end(), [](const Host& host) { return host.is_waiting(); })) hear(100);
  }

  /// Asks one host after the other, so many a second.
  void ask_in_turn(double per_second, double seconds) {
    latencies_.clear();
    const auto begin = Clock::now();
    const auto total = static_cast<std::size_t>(per_second * seconds);
    for (std::size_t i = 0; i < total; ++i) {
      const auto due = begin + std::chrono::duration_cast<Clock::duration>(
                                   std::chrono::duration<double>(static_cast<double>(i) / per_second));
      while (Clock::now() < due) hear(1);
      Host& host = hosts_[i % hosts_.size()];
      while (host.is_waiting()) hear(1);
      host.ask(Opcode::gap, AxisParameter::actual_position, 0);
      hear(0);
    }
    for (int patience = 0; patience < 1000 && latencies_.size() < total; ++patience) hear(10);
  }

  std::size_t answered() const { return latencies_.size(); }
  /// @param share 0.5 is the median
  double latency(double share) {
    std::sort(latencies_.begin(), latencies_.end());
    return latencies_.at(static_cast<std::size_t>(share * static_cast<double>(latencies_.size() - 1)));
  }

 private:
  void hear(int milliseconds) {
    epoll_event events[64];
    const int count = ::epoll_wait(events_.get(), events, 64, milliseconds);
    for (int i = 0; i < count; ++i) {
      Host& host = *static_cast<Host*>(events[i].data.ptr);
      if (host.hear()) latencies_.push_back(host.microseconds_since_asked());
    }
  }

  FileDescriptor events_;
  std::vector<Host> hosts_;
  std::vector<double> latencies_;
};

void measure(const Load& load) {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);

  char folder[] = "/tmp/farm_load.XXXXXX";
  check(::mkdtemp(folder) != nullptr, "mkdtemp");
  {
    const FarmProcess farm(load, folder);
    Hosts hosts(farm.ports());
    if (load.velocity != 0) hosts.ask_all(Opcode::ror, load.velocity);
    // Then ramps are over and the standby current is set.
    std::this_thread::sleep_for(3s);
    const double used = farm.processor_time();
    const auto begin = Clock::now();
    hosts.ask_in_turn(load.commands_per_second, load.seconds);
    const double took = std::chrono::duration<double>(Clock::now() - begin).count();
    const double share = (farm.processor_time() - used) / took * 100;
    std::printf("%zu modules at velocity %d, %.0f commands/s for %.1f s\n", farm.ports().size(), load.velocity,
                load.commands_per_second, took);
    std::printf("processor   %8.1f %% of a core\n", share);
    std::printf("memory      %8.1f MiB, %.1f KiB a module\n", farm.memory(),
                farm.memory() * 1024 / static_cast<double>(farm.ports().size()));
    std::printf("answered    %8zu commands\n", hosts.answered());
    std::printf("latency     %8.0f us median, %.0f us p99, %.0f us longest\n", hosts.latency(0.5), hosts.latency(0.99),
                hosts.latency(1));
  }
  std::filesystem::remove_all(folder);
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 2) {
    std::fprintf(stderr, "usage: %s path/to/tmcl [modules] [commands/s] [seconds] [velocity]\n", arguments[0]);
    return 64;
  }
  try {
    Load load{arguments[1]};
    if (argument_count > 2) load.modules = std::stoul(arguments[2]);
    if (argument_count > 3) load.commands_per_second = std::stod(arguments[3]);
    if (argument_count > 4) load.seconds = std::stod(arguments[4]);
    if (argument_count > 5) load.velocity = std::stoi(arguments[5]);
    measure(load);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "farm_load: %s\n", error.what());
    return 1;
  }
  return 0;
}
