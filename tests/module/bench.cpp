#include "tests/module/bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "lang/assembler.hpp"

namespace opentmcl::tests {

std::size_t TestPort::read(std::uint8_t* buffer, std::size_t capacity) {
  const std::size_t count = std::min(capacity, to_module.size());
  std::copy_n(to_module.begin(), count, buffer);
  to_module.erase(to_module.begin(), to_module.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

Bench::Bench(const ModuleDescription& description, hal::PortKind kind, twin::TraceObserver* observer,
             const VirtualModule::Options& options)
    : module(description, {{&port, kind}}, options, observer) {
  wait(one_millisecond);
}

std::vector<std::uint8_t> Bench::send(const std::vector<std::uint8_t>& bytes) {
  port.received.clear();
  port.to_module.insert(port.to_module.end(), bytes.begin(), bytes.end());
  module.wake();
  wait(3 * one_millisecond);
  return port.received;
}

std::optional<Datagram> Bench::exchange(const Datagram& request) {
  std::vector<std::uint8_t> bytes = send({request.bytes, request.bytes + datagram_size});
  // A command that waits for the EEPROM answers when the page writes before it are over, and a telegram pause may
  // follow.
  for (int turn = 0; bytes.empty() && turn < 300; ++turn) {
    wait(one_millisecond);
    bytes = port.received;
  }
  if (bytes.empty()) return std::nullopt;
  EXPECT_EQ(bytes.size(), datagram_size) << "one reply, and whole";
  Datagram reply;
  std::copy_n(bytes.begin(), std::min(bytes.size(), datagram_size), reply.bytes);
  return reply;
}

Reply Bench::command(const Command& command) {
  const std::optional<Datagram> reply = exchange(encode(Request{1, command}));
  EXPECT_TRUE(reply.has_value()) << "opcode " << int{command.opcode} << " is not answered";
  if (!reply) return {};
  EXPECT_TRUE(reply->checksum_is_right());
  const Reply decoded = decode_reply(*reply);
  EXPECT_EQ(decoded.opcode, command.opcode);
  return decoded;
}

Reply Bench::command(Opcode opcode, std::uint8_t type, std::uint8_t motor, std::int32_t value) {
  return command(Command{static_cast<std::uint8_t>(opcode), type, motor, value});
}

std::int32_t Bench::get(AxisParameter parameter) {
  const Reply reply = command(Opcode::gap, static_cast<std::uint8_t>(parameter));
  EXPECT_EQ(reply.status, Status::ok) << "GAP " << static_cast<int>(parameter);
  return reply.value;
}

void Bench::set(AxisParameter parameter, std::int32_t value) {
  const Reply reply = command(Opcode::sap, static_cast<std::uint8_t>(parameter), 0, value);
  EXPECT_EQ(reply.status, Status::ok) << "SAP " << static_cast<int>(parameter) << ", 0, " << value;
}

std::int32_t Bench::get(GlobalParameter parameter) {
  const Reply reply = command(Opcode::ggp, static_cast<std::uint8_t>(parameter));
  EXPECT_EQ(reply.status, Status::ok) << "GGP " << static_cast<int>(parameter);
  return reply.value;
}

void Bench::set(GlobalParameter parameter, std::int32_t value) {
  const Reply reply = command(Opcode::sgp, static_cast<std::uint8_t>(parameter), 0, value);
  EXPECT_EQ(reply.status, Status::ok) << "SGP " << static_cast<int>(parameter) << ", 0, " << value;
}

void Bench::download(const std::string& source) {
  lang::AssemblerOptions options;
  options.module = &module.description();
  lang::MemoryFiles no_files;
  const lang::AssemblyResult result = lang::assemble("program.tmc", source, options, no_files);
  ASSERT_TRUE(result.program.has_value()) << lang::format(result.diagnostics, result.sources);
  ASSERT_EQ(command(Opcode::enter_download_mode).status, Status::ok);
  for (const Command& instruction : result.program->commands) {
    ASSERT_EQ(command(instruction).status, Status::command_loaded);
  }
  ASSERT_EQ(command(Opcode::exit_download_mode).status, Status::ok);
}

void Bench::run_program(const std::string& source) {
  download(source);
  ASSERT_EQ(command(Opcode::reset_application).status, Status::ok);
  ASSERT_EQ(command(Opcode::run_application).status, Status::ok);
}

Microseconds Bench::wait_until_reached(Microseconds limit) {
  const Microseconds begin = module.now();
  while (get(AxisParameter::position_reached) == 0) {
    if (module.now() - begin > limit) {
      ADD_FAILURE() << "not at the target after " << limit / one_millisecond << " ms";
      break;
    }
    wait(one_millisecond);
  }
  return module.now() - begin;
}

}  // namespace opentmcl::tests
