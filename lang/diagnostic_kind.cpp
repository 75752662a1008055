#include "lang/diagnostic_kind.hpp"

#include "lang/names.hpp"

namespace opentmcl::lang {

const char* name_of(DiagnosticKind kind) {
  return diagnostic_kinds[index_of(kind)].name;
}

std::optional<DiagnosticKind> find_warning(std::string_view name) {
  for (const DiagnosticKindSpec& row : diagnostic_kinds) {
    if (row.severity == Severity::warning && equal_ignoring_case(row.name, name)) return row.kind;
  }
  return std::nullopt;
}

DiagnosticKinds all_warnings() {
  DiagnosticKinds kinds;
  for (const DiagnosticKindSpec& row : diagnostic_kinds) kinds[index_of(row.kind)] = row.severity == Severity::warning;
  return kinds;
}

}  // namespace opentmcl::lang
