#include "tests/conformance/touched.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "lang/assembler.hpp"
#include "lang/file_provider.hpp"
#include "tests/conformance/step.hpp"

namespace opentmcl::conformance {

namespace {

constexpr std::size_t status_byte = 2;

std::vector<Command> commands_of(const Statement& statement, const ModuleDescription& module) {
  if (statement.program.empty()) return {};
  lang::AssemblerOptions options;
  options.module = &module;
  lang::MemoryFiles no_files;
  const lang::AssemblyResult result = lang::assemble(statement.id, statement.program, options, no_files);
  if (!result.program) throw std::runtime_error(lang::format(result.diagnostics, result.sources));
  return result.program->commands;
}

Datagram datagram_of(const Bytes& bytes) {
  Datagram datagram;
  std::copy_n(bytes.begin(), datagram_size, datagram.bytes);
  return datagram;
}

}  // namespace

Touched::Touched(const ConformanceTable& table, const ModuleDescription& module) {
  for (const Statement& statement : table.statements) {
    if (!contains(statement.modules, module.id)) continue;
    for (const Command& command : commands_of(statement, module)) note(command);
    for (const Step& step : parse_steps(statement.steps, module)) {
      if (const auto* const send = std::get_if<SendCommand>(&step.action)) {
        note(send->command);
        if (send->reply) statuses_.insert(send->reply->status);
      } else if (const auto* const send_bytes = std::get_if<SendBytes>(&step.action)) {
        if (send_bytes->bytes.size() == datagram_size) note(decode_request(datagram_of(send_bytes->bytes)).command);
        if (send_bytes->reply.size() == datagram_size) statuses_.insert(send_bytes->reply[status_byte]);
      } else if (const auto* const receive = std::get_if<Receive>(&step.action)) {
        if (receive->bytes.size() == datagram_size) statuses_.insert(receive->bytes[status_byte]);
      }
    }
  }
}

void Touched::note(const Command& command) {
  opcodes_.insert(command.opcode);
  sent_.emplace(command.opcode, command.type, command.motor, command.value);
}

bool Touched::has(Opcode opcode, int type, int motor) const {
  const Sent lowest{static_cast<std::uint8_t>(opcode), static_cast<std::uint8_t>(type),
                    static_cast<std::uint8_t>(motor), std::numeric_limits<std::int32_t>::min()};
  const auto found = sent_.lower_bound(lowest);
  return found != sent_.end() && std::get<0>(*found) == std::get<0>(lowest) &&
         std::get<1>(*found) == std::get<1>(lowest) && std::get<2>(*found) == std::get<2>(lowest);
}

bool Touched::has(Opcode opcode, int type, int motor, std::int32_t value) const {
  return sent_.count({static_cast<std::uint8_t>(opcode), static_cast<std::uint8_t>(type),
                      static_cast<std::uint8_t>(motor), value}) != 0;
}

}  // namespace opentmcl::conformance
