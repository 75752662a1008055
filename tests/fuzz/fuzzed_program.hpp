// A fuzzer's bytes as a source for one of the modules.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "lang/assembler.hpp"

namespace opentmcl::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Some module, but always the same for the same bytes.
inline const ModuleDescription& module_of(std::string_view text) {
  return modules[text.size() % module_count];
}

inline lang::AssemblyResult assemble(std::string_view text, const ModuleDescription& module) {
  lang::MemoryFiles files;
  // Files that include themselves and each other are texts as well.
  files.set("a", std::string(text.substr(0, text.size() / 2)));
  files.set("b", std::string(text.substr(text.size() / 2)));
  lang::AssemblerOptions options;
  options.module = &module;
  options.append_stop = false;
  return lang::assemble("fuzz.tmc", std::string(text), options, files);
}

/// Nothing if there are errors.
inline std::optional<std::vector<Command>> program_of(std::string_view text, const ModuleDescription& module) {
  lang::AssemblyResult result = assemble(text, module);
  if (!result.program) return std::nullopt;
  return std::move(result.program->commands);
}

}  // namespace opentmcl::fuzz
