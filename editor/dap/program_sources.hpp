// The files of a program as the protocol names them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "debug/program.hpp"
#include "editor/dap/protocol.hpp"

namespace opentmcl::editor::dap {

/// Files on the disk go by their path; what the client cannot open, such as built-in files and the disassembly of a
/// module's program, by a number it can ask for the text with.
class ProgramSources {
 public:
  /// `program` must outlive this.
  explicit ProgramSources(const debug::Program& program);

  const debug::Program& program() const { return program_; }

  /// The protocol's Source.
  json source(lang::FileId file) const;
  /// The file a client means. Error: usage, if it is no part of the program.
  client::Result<lang::FileId> find(const json& source) const;
  /// Error: usage.
  client::Result<std::string> text(std::int64_t reference) const;
  /// The protocol's Source of every file.
  json all() const;

  /// Adds source, line and column of an address to an object of the protocol, as far as it has them.
  void put_place(json& object, std::uint16_t address, const ClientConventions& client) const;

 private:
  const debug::Program& program_;
  std::vector<std::string> paths_;  ///< absolute; empty for what is not on the disk
};

/// The path as it is compared with others: absolute, without links and dots.
std::string canonical_path(const std::string& path);

}  // namespace opentmcl::editor::dap
