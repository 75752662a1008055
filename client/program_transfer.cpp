#include "client/program_transfer.hpp"

#include <algorithm>

#include "firmware/spec/instructions.hpp"

namespace opentmcl::client {

namespace {

constexpr Command control_command(Opcode opcode, std::int32_t value) {
  return {static_cast<std::uint8_t>(opcode), 0, 0, value};
}

Error interrupted() {
  return {ErrorKind::interrupted, "interrupted", {}};
}

Result<void> store(Client& client, const Command& instruction, std::size_t address) {
  Result<Reply> reply = client.exchange(instruction);
  if (!reply) return reply.error();
  if (reply->status == Status::command_loaded) return {};
  return Error{ErrorKind::refused,
               "the module did not store instruction " + std::to_string(address) + ": expected status " +
                   std::to_string(static_cast<unsigned>(Status::command_loaded)) + ", got " +
                   std::to_string(static_cast<unsigned>(reply->status)),
               reply->status};
}

Result<void> store_all(Client& client, const std::vector<Command>& program, std::uint16_t address,
                       const Progress& progress) {
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (Result<void> stored = store(client, program[i], address + i); !stored) return stored;
    if (!progress(i + 1, program.size())) return interrupted();
  }
  return {};
}

/// Bit 0 of global parameter 81.
bool protects_against_reading(std::int32_t code_protection) {
  return (code_protection & 1) != 0;
}

bool ends_program(const Command& instruction) {
  return instruction.opcode == end_mark.opcode || is_control_command(instruction.opcode);
}

}  // namespace

std::vector<Command> with_end_mark(std::vector<Command> program, std::size_t capacity) {
  if (program.size() < capacity) program.push_back(end_mark);
  return program;
}

Result<void> download(Client& client, const std::vector<Command>& program, std::uint16_t address,
                      const Progress& progress) {
  if (Result<void> stopped = client.stop_program(); !stopped) return stopped;
  if (auto entered = client.execute(control_command(Opcode::enter_download_mode, address)); !entered) {
    return entered.error();
  }
  Result<void> stored = store_all(client, program, address, progress);
  const Result<std::int32_t> left = client.execute(control_command(Opcode::exit_download_mode, 0));
  if (!stored) return stored;
  if (!left) return left.error();
  return {};
}

Result<Command> read_instruction(Client& client, std::uint16_t address) {
  const Result<Datagram> reply = client.exchange_raw(control_command(Opcode::read_program_memory, address));
  if (!reply) return reply.error();
  if (!reply->checksum_is_right()) {
    return Error{
        ErrorKind::protocol, "instruction " + std::to_string(address) + " came back with a wrong checksum", {}};
  }
  // Host address, then the instruction as a request has it, then the checksum.
  return decode_request(*reply).command;
}

Result<std::vector<Command>> read_program(Client& client, std::uint16_t capacity, const Progress& progress) {
  constexpr auto code_protection = static_cast<std::uint8_t>(GlobalParameter::code_protection);
  const Result<std::int32_t> protection = client.global_parameter(code_protection, Bank::module_settings);
  if (!protection) return protection.error();
  if (protects_against_reading(*protection)) {
    return Error{ErrorKind::refused,
                 "the program in the module is protected against reading (global parameter " +
                     std::to_string(code_protection) + " is " + std::to_string(*protection) +
                     "); taking the protection away erases the program",
                 {}};
  }
  std::vector<Command> program;
  while (program.size() < capacity) {
    const Result<Command> instruction = read_instruction(client, static_cast<std::uint16_t>(program.size()));
    if (!instruction) return instruction.error();
    if (ends_program(*instruction)) break;
    program.push_back(*instruction);
    if (!progress(program.size(), capacity)) return interrupted();
  }
  if (!program.empty()) return program;
  return Error{ErrorKind::refused, "the module holds no program: there is no instruction at address 0", {}};
}

Result<void> verify(Client& client, const std::vector<Command>& program, std::uint16_t address,
                    const Progress& progress) {
  for (std::size_t i = 0; i < program.size(); ++i) {
    const auto place = static_cast<std::uint16_t>(address + i);
    const Result<Command> found = read_instruction(client, place);
    if (!found) return found.error();
    if (*found != program[i]) {
      return Error{ErrorKind::protocol,
                   "instruction " + std::to_string(place) + " in the module is not what was sent: opcode " +
                       std::to_string(found->opcode) + " instead of " + std::to_string(program[i].opcode),
                   {}};
    }
    if (!progress(i + 1, program.size())) return interrupted();
  }
  return {};
}

}  // namespace opentmcl::client
