#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "debug/program.hpp"

namespace opentmcl::debug {

/// Lines of a program as a terminal shows them.
class Listing {
 public:
  /// @param colours escape sequences of a terminal
  Listing(const Program& program, bool colours) : program_(program), colours_(colours) {}

  /// "Loop+2, program.tmc:12"; without a line only the former.
  std::string place(std::uint16_t address) const;

  /// "=> 12   MVP ABS, 0, 1000": the line of the address, or its instruction where there is no source. @param command
  /// what stands there
  std::string current_line(std::uint16_t address, const Command& command) const;

  /// Lines around that of the address. @param has_breakpoint of an address
  std::vector<std::string> lines(std::uint16_t address, std::size_t before, std::size_t count, std::uint16_t here,
                                 const std::function<bool(std::uint16_t)>& has_breakpoint) const;

  std::string emphasised(const std::string& text) const;
  std::string faint(const std::string& text) const;

 private:
  std::string marked(bool is_here, bool has_breakpoint, const std::string& number, const std::string& text) const;
  std::string coloured(const char* sequence, const std::string& text) const;

  const Program& program_;
  bool colours_;
};

}  // namespace opentmcl::debug
