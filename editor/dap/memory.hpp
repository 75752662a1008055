// The program memory as the protocol sees it: bytes.
//
// The bytes are those of a program file, eight an instruction (lang/program_file.hpp), so the memory reference of the
// instruction at address n is 8 n (docs/decisions/0080-addresses-in-editors.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "debug/engine.hpp"
#include "editor/dap/program_sources.hpp"
#include "editor/dap/protocol.hpp"

namespace opentmcl::editor::dap {

/// "0x28" for address 5.
std::string memory_reference(std::uint16_t address);

/// The instruction at a reference and some bytes behind it. Error: usage, if there is none.
client::Result<std::uint16_t> address_of_reference(const std::string& reference, std::int64_t byte_offset,
                                                   const ModuleDescription& module);

/// The body of a readMemory response. Errors: usage, and those of client::read_instruction.
Answer read_memory(debug::Engine& engine, const json& arguments);

/// The body of a disassemble response, with as many instructions as were asked for. Errors likewise.
Answer disassemble(debug::Engine& engine, const ProgramSources& sources, const ClientConventions& client,
                   const json& arguments);

}  // namespace opentmcl::editor::dap
