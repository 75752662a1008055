// Round trips of nine bytes per second through a pseudo terminal: a virtual module against a program that only sends
// back what it gets. Both are processes of their own, asked in turns, so that whatever else the machine does hits both.
// And single steps of the debugger through the same pseudo terminal, each of which takes two round trips.
//
// usage: pty_round_trips path/to/tmcl [rounds] [round trips per round]

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <termios.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "client/client.hpp"
#include "client/file_descriptor.hpp"
#include "client/serial_transport.hpp"
#include "debug/engine.hpp"
#include "debug/module_target.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"

namespace {

using opentmcl::datagram_size;
using opentmcl::client::FileDescriptor;

void check(bool good, const char* what) {
  if (!good) throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

void make_raw(int terminal) {
  termios settings{};
  check(::tcgetattr(terminal, &settings) == 0, "tcgetattr");
  ::cfmakeraw(&settings);
  check(::tcsetattr(terminal, TCSANOW, &settings) == 0, "tcsetattr");
}

/// A child process that ends with this.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }

 private:
  pid_t process_;
};

/// Sends back what it gets, for ever: the least any program behind a pseudo terminal does.
[[noreturn]] void echo(int stream) {
  unsigned char buffer[datagram_size];
  while (true) {
    const ssize_t count = ::read(stream, buffer, sizeof buffer);
    if (count <= 0 || ::write(stream, buffer, static_cast<std::size_t>(count)) != count) ::_exit(1);
  }
}

pid_t start_echo(int own_side) {
  const pid_t process = ::fork();
  check(process >= 0, "fork");
  if (process == 0) echo(own_side);
  return process;
}

/// Starts `tmcl sim` with its link at `link`, and returns when it has introduced itself.
pid_t start_simulation(const char* program, const std::string& link) {
  int ends[2];
  check(::pipe(ends) == 0, "pipe");
  const pid_t process = ::fork();
  check(process >= 0, "fork");
  if (process == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::execl(program, program, "sim", "--quiet", "--tcp", "none", "--pty-link", link.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(ends[1]);
  const FileDescriptor output(ends[0]);
  char first = 0;
  check(::read(output.get(), &first, 1) == 1, "tmcl sim did not start");
  // The rest of the introduction fits the pipe; nobody reads it.
  return process;
}

/// Seconds for `count` round trips, one at a time.
double measure(int port, int count) {
  using opentmcl::Opcode;
  const opentmcl::Datagram request =
      encode(opentmcl::Request{1,
                               {static_cast<std::uint8_t>(Opcode::gap),
                                static_cast<std::uint8_t>(opentmcl::AxisParameter::actual_position), 0, 0}});
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) {
    check(::write(port, request.bytes, datagram_size) == static_cast<ssize_t>(datagram_size), "write");
    unsigned char reply[datagram_size];
    std::size_t received = 0;
    while (received < datagram_size) {
      const ssize_t part = ::read(port, reply + received, datagram_size - received);
      check(part > 0, "read");
      received += static_cast<std::size_t>(part);
    }
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A program of a virtual module that is debugged through its pseudo terminal.
class SteppedProgram {
 public:
  explicit SteppedProgram(const std::string& port)
      : transport_(value_of(opentmcl::client::open_serial(port))),
        client_(*transport_),
        target_(client_, opentmcl::pd1161),
        engine_(target_, loop()) {
    const auto every = [](std::size_t, std::size_t) { return true; };
    value_of(engine_.download(value_of(engine_.compare(every)), every));
    value_of(engine_.restart());
  }

  /// Seconds for `count` steps, one at a time.
  double measure(int count) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) {
      value_of(engine_.go({opentmcl::debug::Motion::Kind::step, 0, {}}, [](const auto&) { return true; }));
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

 private:
  template <class T>
  static T value_of(opentmcl::client::Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
  }

  static opentmcl::debug::Program loop() {
    using opentmcl::Opcode;
    return opentmcl::debug::Program::disassembled({{static_cast<std::uint8_t>(Opcode::calc), 0, 0, 1},
                                                   {static_cast<std::uint8_t>(Opcode::calcx), 0, 0, 0},
                                                   {static_cast<std::uint8_t>(Opcode::ja), 0, 0, 0}},
                                                  opentmcl::pd1161, "loop");
  }

  std::unique_ptr<opentmcl::client::Transport> transport_;
  opentmcl::client::Client client_;
  opentmcl::debug::ModuleTarget target_;
  opentmcl::debug::Engine engine_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void compare(const char* program, int rounds, int count) {
  char folder[] = "/tmp/pty_round_trips.XXXXXX";
  check(::mkdtemp(folder) != nullptr, "mkdtemp");
  const std::string link = std::string(folder) + "/link";

  const FileDescriptor own_side(::posix_openpt(O_RDWR | O_NOCTTY));
  check(own_side.is_open() && ::grantpt(own_side.get()) == 0 && ::unlockpt(own_side.get()) == 0, "pseudo terminal");
  const FileDescriptor echo_port(::open(::ptsname(own_side.get()), O_RDWR | O_NOCTTY));
  check(echo_port.is_open(), "pseudo terminal");
  make_raw(echo_port.get());

  std::vector<double> echo_times;
  std::vector<double> module_times;
  std::vector<double> ratios;
  std::vector<double> step_times;
  std::vector<double> step_ratios;
  {
    const Child echo_process(start_echo(own_side.get()));
    const Child simulation(start_simulation(program, link));
    const FileDescriptor module_port(::open(link.c_str(), O_RDWR | O_NOCTTY));
    check(module_port.is_open(), link.c_str());
    make_raw(module_port.get());
    measure(echo_port.get(), count);
    measure(module_port.get(), count);
    SteppedProgram program_of_module(link);
    for (int round = 0; round < rounds; ++round) {
      echo_times.push_back(measure(echo_port.get(), count));
      module_times.push_back(measure(module_port.get(), count));
      ratios.push_back(echo_times.back() / module_times.back());
      step_times.push_back(program_of_module.measure(count));
      step_ratios.push_back(echo_times.back() / step_times.back());
    }
  }
  ::rmdir(folder);
  std::printf("bare echo   %8.0f round trips/s\n", count / median(echo_times));
  std::printf("tmcl sim    %8.0f round trips/s\n", count / median(module_times));
  std::printf("ratio       %8.3f (median of %d rounds of %d)\n", median(ratios), rounds, count);
  std::printf("debugger    %8.0f steps/s\n", count / median(step_times));
  std::printf("ratio       %8.3f to the bare echo, %.3f to tmcl sim\n", median(step_ratios),
              median(module_times) / median(step_times));
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 2) {
    std::fprintf(stderr, "usage: %s path/to/tmcl [rounds] [round trips per round]\n", arguments[0]);
    return 64;
  }
  const int rounds = argument_count > 2 ? std::stoi(arguments[2]) : 41;
  const int count = argument_count > 3 ? std::stoi(arguments[3]) : 2000;
  try {
    compare(arguments[1], rounds, count);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pty_round_trips: %s\n", error.what());
    return 1;
  }
  return 0;
}
