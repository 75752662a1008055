#include <cstddef>
#include <cstdint>
#include <vector>

#include "lang/disassembler.hpp"
#include "lang/program_file.hpp"
#include "tests/fuzz/fuzzed_program.hpp"
#include "tests/fuzz/property.hpp"

using namespace opentmcl;
using fuzz::require;

namespace {

/// Seven bytes an instruction: a fuzzer need not find out checksums.
std::vector<Command> commands_of(const std::uint8_t* data, std::size_t size) {
  std::vector<Command> commands;
  for (; size >= 7; data += 7, size -= 7) commands.push_back({data[0], data[1], data[2], get_int32(data + 3)});
  return commands;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ModuleDescription& module = fuzz::module_of(fuzz::text_of(data, size));
  const std::vector<std::uint8_t> bytes(data, data + size);
  if (const lang::ProgramFileResult file = lang::from_program_file(bytes); file.commands) {
    require(lang::to_program_file(*file.commands) == bytes, "a program file is read and written alike");
  } else {
    require(!file.error.empty(), "a file that is none has a reason");
  }

  std::vector<Command> commands = commands_of(data, size);
  if (commands.size() > module.program_capacity) commands.resize(module.program_capacity);
  for (const lang::Comments comments : {lang::Comments::none, lang::Comments::meanings}) {
    const lang::Disassembly disassembly = lang::disassemble(commands, module, comments);
    const auto program = fuzz::program_of(disassembly.text, module);
    require(program.has_value(), "a disassembly can be assembled");
    require(disassembly.problems.empty() ? *program == commands
                                         : program->size() == commands.size() - disassembly.problems.size(),
            "source and binary are inverse");
  }
  return 0;
}
