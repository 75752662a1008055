// The whole table: every file of tables/, in the order of the manual.
#pragma once

#include <string>
#include <vector>

#include "tests/conformance/statement.hpp"

namespace opentmcl::conformance {

/// A numbered section of chapters 3 to 8; one of the numbers is empty where one manual lacks it.
struct Section {
  std::string pd1161;
  std::string tmcm1110;
  std::string title;
};

struct ConformanceTable {
  std::vector<Section> sections;  ///< in the order of the manual
  Statements statements;
};

/// @param folder that of tests/conformance/tables
/// @throws std::runtime_error when a file is malformed or an id is used twice for a module
ConformanceTable read_conformance_table(const std::string& folder);

/// The sections a statement names, as they stand in Statement::section.
std::vector<std::string> sections_of(const Statement& statement);
/// Whether a statement names a section.
bool is_in(const Statement& statement, const Section& section);
/// Whether a tested statement, not a mere decision, is about a section of this module's manual or one within it.
bool is_covered(const ConformanceTable& table, const Section& section, ModuleId module);
/// Number of a section in the manual of a module; empty when that manual lacks it.
const std::string& number_in(ModuleId module, const Section& section);

}  // namespace opentmcl::conformance
