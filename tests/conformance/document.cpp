#include "tests/conformance/document.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace opentmcl::conformance {

namespace {

constexpr const char* introduction = R"(# Conformance

What the two manuals state, section by section, and the test of each statement. Generated from `tests/conformance/tables`
by `conformance_document`; a test compares, so edit the tables and write this file anew
(`tests/conformance/README.md`).

A statement is **tested** when its steps run against a virtual module over a byte port; none that fails is in the table.
One that no manual makes is tested too, but counts as a **decision** and stands at the end, with the file that explains
it. *PD* is the manual of the PD-1161 (V1.47), *TM* that of the TMCM-1110 (V1.08) with the facts known about it.

)";

bool is_decision(const Statement& statement) {
  return !statement.decision.empty();
}

std::string title_of(const Section& section) {
  std::string numbers = section.pd1161.empty() ? "" : "PD " + section.pd1161;
  if (!section.tmcm1110.empty()) numbers += (numbers.empty() ? "TM " : ", TM ") + section.tmcm1110;
  return section.title + " (" + numbers + ")";
}

const char* state(const Statement& statement, ModuleId module) {
  return contains(statement.modules, module) ? "tested" : "";
}

std::string row_of(const Statement& statement) {
  return "| `" + statement.id + "` | " + statement.says + " | " + state(statement, ModuleId::pd1161) + " | " +
         state(statement, ModuleId::tmcm1110) + " |\n";
}

/// The statements that name a section, first those for which it is the first one named.
struct Members {
  std::vector<const Statement*> own;
  std::vector<const Statement*> others;
};

Members members_of(const ConformanceTable& table, const Section& section) {
  Members members;
  for (const Statement& statement : table.statements) {
    if (is_decision(statement)) continue;
    if (!is_in(statement, section)) continue;
    Statement first = statement;
    first.section = sections_of(statement).front();
    (is_in(first, section) ? members.own : members.others).push_back(&statement);
  }
  return members;
}

/// Statements that say the same of both modules in one row.
std::vector<Statement> joined(const std::vector<const Statement*>& statements) {
  std::vector<Statement> rows;
  for (const Statement* statement : statements) {
    const auto same = std::find_if(rows.begin(), rows.end(), [statement](const Statement& row) {
      return row.id == statement->id && row.says == statement->says;
    });
    if (same == rows.end()) {
      rows.push_back(*statement);
    } else {
      same->modules = Modules::both;
    }
  }
  return rows;
}

std::string section_text(const ConformanceTable& table, const Section& section) {
  const Members members = members_of(table, section);
  if (members.own.empty() && members.others.empty()) return {};  // a heading of the manual; what is in it follows
  std::string text = "## " + title_of(section) + "\n\n";
  if (!members.own.empty()) {
    text += "| Test | Statement | PD-1161 | TMCM-1110 |\n|---|---|---|---|\n";
    for (const Statement& row : joined(members.own)) text += row_of(row);
    text += '\n';
  }
  if (!members.others.empty()) {
    text += "Also";
    std::string separator = ": ";
    for (const Statement& row : joined(members.others)) {
      text += separator + '`' + row.id + '`';
      separator = ", ";
    }
    text += ".\n\n";
  }
  return text;
}

std::size_t count(const Statements& statements, ModuleId module, bool decisions) {
  return static_cast<std::size_t>(
      std::count_if(statements.begin(), statements.end(), [module, decisions](const Statement& statement) {
        return is_decision(statement) == decisions && contains(statement.modules, module);
      }));
}

std::string summary(const ConformanceTable& table) {
  std::string sections = "| sections with tested statements";
  std::string statements = "| statements tested, 0 failing";
  std::string decisions = "| decisions";
  for (const ModuleId module : {ModuleId::pd1161, ModuleId::tmcm1110}) {
    const auto exists = [module](const Section& section) { return !number_in(module, section).empty(); };
    const auto all = std::count_if(table.sections.begin(), table.sections.end(), exists);
    const auto covered = std::count_if(table.sections.begin(), table.sections.end(), [&](const Section& section) {
      return exists(section) && is_covered(table, section, module);
    });
    sections += " | " + std::to_string(covered) + " of " + std::to_string(all);
    statements += " | " + std::to_string(count(table.statements, module, false));
    decisions += " | " + std::to_string(count(table.statements, module, true));
  }
  return "| | PD-1161 | TMCM-1110 |\n|---|---:|---:|\n" + sections + " |\n" + statements + " |\n" + decisions +
         " |\n\n";
}

std::string decisions_text(const ConformanceTable& table) {
  std::map<std::string, std::vector<const Statement*>> by_file;
  for (const Statement& statement : table.statements) {
    if (is_decision(statement)) by_file[statement.decision].push_back(&statement);
  }
  std::string text =
      "## Decisions\n\nNot stated by any manual and so not counted as covered; numbers are files in "
      "`docs/decisions`.\n\n| Decision | Test | Choice | PD-1161 | TMCM-1110 |\n|---|---|---|---|---|\n";
  for (const auto& [file, statements] : by_file) {
    for (const Statement& row : joined(statements)) text += "| " + file + ' ' + row_of(row);
  }
  return text;
}

}  // namespace

std::string document_of(const ConformanceTable& table) {
  std::string text = introduction + summary(table);
  for (const Section& section : table.sections) text += section_text(table, section);
  return text + decisions_text(table);
}

}  // namespace opentmcl::conformance
