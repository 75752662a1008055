#include "tests/conformance/conformance_table.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/conformance/statement_file.hpp"
#include "tests/conformance/table_statements.hpp"

namespace opentmcl::conformance {

namespace {

/// In front of a section's number in the manual of the TMCM-1110.
const std::string tmcm1110_prefix = "TM-";

void append(Statements& all, Statements some) {
  all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
}

std::vector<std::string> toml_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool has_section(const ConformanceTable& table, const std::string& number) {
  return std::any_of(table.sections.begin(), table.sections.end(), [&number](const Section& section) {
    return number == section.pd1161 || number == tmcm1110_prefix + section.tmcm1110;
  });
}

void check(const ConformanceTable& table) {
  std::set<std::pair<std::string, ModuleId>> ids;
  for (const Statement& statement : table.statements) {
    for (const ModuleDescription& module : modules) {
      if (!contains(statement.modules, module.id)) continue;
      if (!ids.emplace(statement.id, module.id).second) {
        throw std::runtime_error("two statements for the " + std::string(module.name) + " are called " + statement.id);
      }
    }
    for (const std::string& section : sections_of(statement)) {
      if (!has_section(table, section)) throw std::runtime_error(statement.id + ": no section " + section);
    }
  }
}

}  // namespace

ConformanceTable read_conformance_table(const std::string& folder) {
  const auto table = [&folder](const char* name) { return read_table(folder + '/' + name + ".tsv"); };
  ConformanceTable result;
  for (const TableRow& row : table("sections")) result.sections.push_back({row["pd"], row["tm"], row["title"]});
  Statements& all = result.statements;
  for (const std::string& file : toml_files(folder)) append(all, read_statements(file));
  append(all, command_statements(table("commands")));
  append(all, datagram_statements());
  append(all, calculation_statements(table("calculations")));
  append(all, condition_statements(table("conditions")));
  append(all, interrupt_statements(table("interrupts")));
  append(all, io_port_statements(table("io_ports")));
  append(all, axis_parameter_statements(table("axis_parameters")));
  append(all, global_parameter_statements(table("global_parameters")));
  check(result);
  return result;
}

std::vector<std::string> sections_of(const Statement& statement) {
  std::istringstream words(statement.section);
  return {std::istream_iterator<std::string>(words), {}};
}

bool is_in(const Statement& statement, const Section& section) {
  const std::vector<std::string> named = sections_of(statement);
  return std::any_of(named.begin(), named.end(), [&section](const std::string& name) {
    return name == section.pd1161 || name == tmcm1110_prefix + section.tmcm1110;
  });
}

bool is_covered(const ConformanceTable& table, const Section& section, ModuleId module) {
  const std::string& number = number_in(module, section);
  return std::any_of(table.sections.begin(), table.sections.end(), [&](const Section& part) {
    const std::string& part_number = number_in(module, part);
    if (part_number != number && part_number.rfind(number + '.', 0) != 0) return false;
    return std::any_of(table.statements.begin(), table.statements.end(), [&](const Statement& statement) {
      return statement.decision.empty() && contains(statement.modules, module) && is_in(statement, part);
    });
  });
}

const std::string& number_in(ModuleId module, const Section& section) {
  return module == ModuleId::pd1161 ? section.pd1161 : section.tmcm1110;
}

}  // namespace opentmcl::conformance
