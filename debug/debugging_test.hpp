// For tests: a program and an engine that debugs it.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "debug/engine.hpp"
#include "lang/assembler.hpp"
#include "lang/file_provider.hpp"

namespace opentmcl::debug {

/// Adds five to variable 2, three times.
inline constexpr std::string_view counting = R"(
        SGP 1, 2, 3        // 0
Loop:   CSUB Work          // 1
        DJNZ 1, Loop       // 2
        STOP               // 3
Work:   GGP 2, 2           // 4
        CALC ADD, 5        // 5
        AGP 2, 2           // 6
        RSUB               // 7
)";

inline Program program_of(std::string_view text, const ModuleDescription& module = pd1161) {
  lang::MemoryFiles files;
  lang::AssemblerOptions options;
  options.module = &module;
  lang::AssemblyResult result = lang::assemble("program.tmc", std::string(text), options, files);
  if (!result.program) throw std::runtime_error(lang::format(result.diagnostics, result.sources));
  return {std::move(result), module};
}

/// The value, or an exception with what is wrong.
template <class T>
T value_of(client::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}
inline void expect_done(const client::Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

inline bool always(const Underway&) {
  return true;
}
inline bool every_progress(std::size_t, std::size_t) {
  return true;
}

/// Loads the program and stands at its begin.
inline void launch(Engine& engine) {
  const MemoryComparison comparison = value_of(engine.compare(every_progress));
  value_of(engine.download(comparison, every_progress));
  value_of(engine.restart());
}

inline Stop go(Engine& engine, Motion::Kind kind, std::uint16_t address = 0) {
  return value_of(engine.go({kind, address, {}}, always));
}

inline int break_at(Engine& engine, std::uint16_t address) {
  BreakpointRequest request;
  request.address = address;
  return value_of(engine.add(std::move(request)));
}

}  // namespace opentmcl::debug
