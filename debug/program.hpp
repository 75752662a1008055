// A program as its debugger sees it: instructions, and the lines of the source they came from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/spec/modules.hpp"
#include "firmware/wire/datagram.hpp"
#include "lang/assembler.hpp"

namespace opentmcl::debug {

/// A line of a source; both count from 1.
struct Line {
  lang::FileId file = 0;
  std::size_t line = 0;
  std::size_t column = 1;

  friend constexpr bool operator==(const Line&, const Line&) = default;
};

class Program {
 public:
  /// @pre `assembled` has a program
  Program(lang::AssemblyResult assembled, const ModuleDescription& module);
  /// Of a program without a source, such as one that was read out of a module: its source is its disassembly.
  static Program disassembled(std::vector<Command> commands, const ModuleDescription& module, std::string_view name);

  const ModuleDescription& module() const { return *module_; }
  const std::vector<Command>& commands() const { return program_.commands; }
  std::size_t size() const { return program_.commands.size(); }

  /// Files by lang::FileId; file 0 is the main one.
  std::size_t file_count() const { return sources_.size(); }
  const std::string& file_name(lang::FileId file) const { return sources_[file].name; }
  std::size_t line_count(lang::FileId file) const { return indices_[file].line_count(); }
  /// Without its end; UTF-8 or not, as the file is.
  std::string_view line_text(lang::FileId file, std::size_t line) const { return indices_[file].line(line); }
  /// The file that the user calls `name`: its whole name, or the part behind a slash if only one file ends so.
  std::optional<lang::FileId> find_file(std::string_view name) const;

  /// Nothing for the STOP that the assembler appended, and outside the program.
  std::optional<Line> line_of(std::uint16_t address) const;
  /// The first instruction on the line or, if it has none, on one of those below in the same file.
  std::optional<std::uint16_t> address_of(lang::FileId file, std::size_t line) const;

  const std::vector<lang::Label>& labels() const { return program_.labels; }
  std::optional<std::uint16_t> address_of_label(std::string_view name) const;
  /// A label's address or a constant of the source.
  std::optional<double> value_of_name(std::string_view name) const;
  /// The last label at or before the address: "Loop", and how many instructions after it.
  struct Place {
    std::string_view label;  ///< empty: there is none
    unsigned offset = 0;
  };
  Place place_of(std::uint16_t address) const;
  /// "Loop+2", "4" where there is no label.
  std::string name_of(std::uint16_t address) const;

  /// "MVP ABS, 0, 1000", or its four numbers where there is no mnemonic.
  std::string text_of(const Command& command) const;

 private:
  lang::Program program_;
  lang::Sources sources_;
  lang::SymbolTable symbols_;             // names are texts of the sources
  std::vector<lang::LineIndex> indices_;  // by file
  std::vector<std::uint16_t> by_place_;   // addresses with a line, by file and offset
  const ModuleDescription* module_;
};

}  // namespace opentmcl::debug
