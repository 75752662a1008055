#include "lang/c_array.hpp"

#include <cstddef>
#include <cstdint>

#include "firmware/spec/instructions.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/hexadecimal.hpp"
#include "lang/instruction_table.hpp"
#include "lang/names.hpp"

namespace opentmcl::lang {
namespace {

constexpr std::size_t instruction_size = 7;

/// A part of an identifier: never empty, never beginning with a digit or an underscore.
std::string identifier_of(std::string_view name) {
  std::string identifier;
  for (const char c : name) identifier += continues_name(c) ? c : '_';
  if (identifier.empty() || identifier.front() == '_' || is_digit(identifier.front())) identifier.insert(0, "tmcl_");
  return identifier;
}

std::string upper_case(std::string name) {
  for (char& c : name) c = to_upper(c);
  return name;
}

/// Nothing in it ends or begins a comment.
std::string comment_text(std::string_view text) {
  std::string result = to_utf8(text);
  for (char& c : result) {
    if (c == '*' || c == '\\' || static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return result;
}

std::string row(const Command& command) {
  std::uint8_t bytes[instruction_size] = {command.opcode, command.type, command.motor};
  put_int32(bytes + 3, command.value);
  std::string text = "    {";
  for (const std::uint8_t& byte : bytes) {
    if (&byte != bytes) text += ", ";
    text += "0x" + hexadecimal(byte);
  }
  return text + "},";
}

}  // namespace

std::string c_array(const Program& program, const Sources& sources, const ModuleDescription& module,
                    std::string_view name) {
  const std::string lower = identifier_of(name);
  const std::string upper = upper_case(lower);
  const std::string length = upper + "_LENGTH";
  std::string text = "/* " + comment_text(sources[0].name) + ", assembled for the " + describe(module) + " */\n";
  text += "#ifndef " + upper + "_H\n#define " + upper + "_H\n\n#include <stdint.h>\n\n";
  text +=
      "/* Instructions of the program. */\n#define " + length + " " + std::to_string(program.commands.size()) + "\n";
  if (!program.commands.empty()) {
    text +=
        "\n/* Of each instruction opcode, type, motor and the four bytes of the value, most significant first. */\n";
    text += "static const uint8_t " + lower + "[" + length + "][" + std::to_string(instruction_size) + "] = {\n";
    for (std::size_t address = 0; address < program.commands.size(); ++address) {
      const Span span = program.source_map[address];
      const std::string source = span.length == 0 ? "STOP" : comment_text(sources.text_of(span));
      text += row(program.commands[address]) + " /* " + std::to_string(address) + ": " + source + " */\n";
    }
    text += "};\n";
  }
  return text + "\n#endif\n";
}

}  // namespace opentmcl::lang
