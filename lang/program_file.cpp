#include "lang/program_file.hpp"

#include <utility>

#include "lang/hexadecimal.hpp"

namespace opentmcl::lang {
namespace {

std::uint8_t record_checksum(const std::uint8_t* record) {
  unsigned sum = 0;
  for (std::size_t i = 0; i + 1 < program_file_record_size; ++i) sum += record[i];
  return static_cast<std::uint8_t>(sum);
}

}  // namespace

std::vector<std::uint8_t> to_program_file(const std::vector<Command>& commands) {
  std::vector<std::uint8_t> bytes(commands.size() * program_file_record_size);
  std::uint8_t* record = bytes.data();
  for (const Command& command : commands) {
    record[0] = command.opcode;
    record[1] = command.type;
    record[2] = command.motor;
    put_int32(record + 3, command.value);
    record[7] = record_checksum(record);
    record += program_file_record_size;
  }
  return bytes;
}

ProgramFileResult from_program_file(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() % program_file_record_size != 0) {
    return {std::nullopt, "a program file is a multiple of 8 bytes long, this one is " + std::to_string(bytes.size())};
  }
  std::vector<Command> commands;
  commands.reserve(bytes.size() / program_file_record_size);
  for (std::size_t i = 0; i < bytes.size(); i += program_file_record_size) {
    const std::uint8_t* const record = bytes.data() + i;
    if (record[7] != record_checksum(record)) {
      return {std::nullopt, "the checksum of instruction " + std::to_string(commands.size()) + " is " +
                                hexadecimal(record[7]) + ", expected " + hexadecimal(record_checksum(record))};
    }
    commands.push_back({record[0], record[1], record[2], get_int32(record + 3)});
  }
  return {std::move(commands), {}};
}

}  // namespace opentmcl::lang
