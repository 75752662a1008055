#include "editor/dap/memory.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <system_error>
#include <vector>

#include "editor/dap/base64.hpp"
#include "lang/diagnostic.hpp"
#include "lang/program_file.hpp"

namespace opentmcl::editor::dap {

using client::Result;
using lang::program_file_record_size;

namespace {

constexpr auto record_size = static_cast<std::int64_t>(program_file_record_size);

/// No client shows more at once, and beyond it sums could overflow.
constexpr std::int64_t largest_offset = std::int64_t{1} << 31;

std::int64_t memory_size(const ModuleDescription& module) {
  return module.program_capacity * record_size;
}

std::string hexadecimal(std::int64_t number) {
  std::array<char, 16> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return std::string("0x").append(digits.data(), end);
}

Result<std::int64_t> byte_of_reference(std::string_view reference) {
  const bool is_hexadecimal = reference.starts_with("0x") || reference.starts_with("0X");
  const std::string_view digits = reference.substr(is_hexadecimal ? 2 : 0);
  std::int64_t number = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), number, is_hexadecimal ? 16 : 10);
  if (error != std::errc{} || end != digits.data() + digits.size() || number > largest_offset ||
      number < -largest_offset) {
    return mistake("a memory reference is a number such as 0x28, not " + lang::in_quotes(reference));
  }
  return number;
}

/// An integer of the arguments that is no larger than anything sensible.
Result<std::int64_t> offset_of(const json& arguments, const char* name) {
  Result<std::int64_t> offset = optional_integer(arguments, name, 0);
  if (offset.ok() && (*offset > largest_offset || *offset < -largest_offset)) {
    return mistake(lang::in_quotes(name).append(" is ").append(std::to_string(*offset)).append(": beyond any memory"));
  }
  return offset;
}

Result<std::int64_t> count_of(const json& arguments, const char* name, std::int64_t most) {
  Result<std::int64_t> count = required_integer(arguments, name);
  if (count.ok() && (*count < 0 || *count > most)) {
    const std::string expected = ": expected 0 to " + std::to_string(most);
    return mistake(lang::in_quotes(name).append(" is ").append(std::to_string(*count)).append(expected));
  }
  return count;
}

Result<std::int64_t> begin_of(const json& arguments, const char* offset_name) {
  const Result<std::string> reference = required_text(arguments, "memoryReference");
  if (!reference) return reference.error();
  const Result<std::int64_t> byte = byte_of_reference(*reference);
  if (!byte) return byte.error();
  const Result<std::int64_t> offset = offset_of(arguments, offset_name);
  if (!offset) return offset.error();
  return *byte + *offset;
}

/// "05 04 00 00 00 00 03 E8": as a program file has it.
std::string bytes_text(const Command& command) {
  std::string text;
  for (const std::uint8_t byte : lang::to_program_file({command})) {
    std::array<char, 4> digits{};
    std::snprintf(digits.data(), digits.size(), "%02X", unsigned{byte});
    text.append(text.empty() ? "" : " ").append(digits.data());
  }
  return text;
}

}  // namespace

std::string memory_reference(std::uint16_t address) {
  return hexadecimal(address * record_size);
}

Result<std::uint16_t> address_of_reference(const std::string& reference, std::int64_t byte_offset,
                                           const ModuleDescription& module) {
  const Result<std::int64_t> base = byte_of_reference(reference);
  if (!base) return base.error();
  const bool is_sensible = byte_offset >= -largest_offset && byte_offset <= largest_offset;
  const std::int64_t byte = *base + (is_sensible ? byte_offset : 0);
  if (!is_sensible || byte < 0 || byte >= memory_size(module) || byte % record_size != 0) {
    return mistake("no instruction begins at byte " + std::to_string(byte) + ": expected a multiple of " +
                   std::to_string(record_size) + " below " + std::to_string(memory_size(module)));
  }
  return static_cast<std::uint16_t>(byte / record_size);
}

Answer read_memory(debug::Engine& engine, const json& arguments) {
  const std::int64_t size = memory_size(engine.program().module());
  const Result<std::int64_t> begin = begin_of(arguments, "offset");
  if (!begin) return begin.error();
  const Result<std::int64_t> count = count_of(arguments, "count", largest_offset);
  if (!count) return count.error();
  if (*begin < 0 || *begin >= size) {
    return mistake("there is no byte " + std::to_string(*begin) + ": the program memory has " + std::to_string(size));
  }
  const std::int64_t end = std::min(*begin + *count, size);
  std::vector<std::uint8_t> bytes;
  for (std::int64_t address = *begin / record_size; address * record_size < end; ++address) {
    const Result<Command> command = engine.command_at(static_cast<std::uint16_t>(address));
    if (!command) return command.error();
    const std::vector<std::uint8_t> record = lang::to_program_file({*command});
    const std::int64_t first = std::max(*begin - address * record_size, std::int64_t{0});
    const std::int64_t last = std::min(end - address * record_size, record_size);
    bytes.insert(bytes.end(), record.begin() + first, record.begin() + last);
  }
  json body{{"address", hexadecimal(*begin)}, {"data", base64(bytes)}};
  const std::int64_t unreadable = *count - static_cast<std::int64_t>(bytes.size());
  if (unreadable > 0) body["unreadableBytes"] = unreadable;
  return body;
}

Answer disassemble(debug::Engine& engine, const ProgramSources& sources, const ClientConventions& client,
                   const json& arguments) {
  const debug::Program& program = engine.program();
  const std::int64_t capacity = program.module().program_capacity;
  const Result<std::int64_t> begin = begin_of(arguments, "offset");
  if (!begin) return begin.error();
  const Result<std::int64_t> instruction_offset = offset_of(arguments, "instructionOffset");
  if (!instruction_offset) return instruction_offset.error();
  // Clients ask for some hundred instructions around a place, beyond both ends of the memory, too.
  const Result<std::int64_t> count = count_of(arguments, "instructionCount", 4 * capacity);
  if (!count) return count.error();
  if (*begin % record_size != 0) {
    return mistake("no instruction begins at byte " + std::to_string(*begin) + ": each has " +
                   std::to_string(record_size));
  }
  const std::int64_t first = *begin / record_size + *instruction_offset;
  json instructions = json::array();
  for (std::int64_t address = first; address < first + *count; ++address) {
    const std::int64_t byte = address * record_size;
    if (address < 0 || address >= capacity) {
      // A negative number has no hexadecimal form in the protocol.
      const std::string reference = byte < 0 ? std::to_string(byte) : hexadecimal(byte);
      instructions.push_back(
          {{"address", reference}, {"instruction", "outside the memory"}, {"presentationHint", "invalid"}});
      continue;
    }
    const auto place = static_cast<std::uint16_t>(address);
    const Result<Command> command = engine.command_at(place);
    if (!command) return command.error();
    json instruction{{"address", hexadecimal(byte)},
                     {"instructionBytes", bytes_text(*command)},
                     {"instruction", program.text_of(*command)}};
    if (place < program.size()) {
      const debug::Program::Place label = program.place_of(place);
      if (!label.label.empty() && label.offset == 0) instruction["symbol"] = label.label;
      json at = json::object();
      sources.put_place(at, place, client);
      if (!at.empty()) {
        instruction["location"] = at["source"];
        instruction["line"] = at["line"];
        instruction["column"] = at["column"];
      }
    }
    instructions.push_back(std::move(instruction));
  }
  return json{{"instructions", std::move(instructions)}};
}

}  // namespace opentmcl::editor::dap
