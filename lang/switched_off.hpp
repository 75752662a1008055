// Warnings a source switches off itself, by a comment: at the end of a line for what is reported in that line, on a
// line of its own for all of its file.
//   SAP 4, 0, 50000  // no-warning: parameter-out-of-range
//   // no-warning: unused-label, unused-constant
#pragma once

#include <vector>

#include "lang/diagnostic.hpp"
#include "lang/source.hpp"

namespace opentmcl::lang {

/// Leaves out the warnings that comments in the sources switch off.
std::vector<Diagnostic> without_switched_off(std::vector<Diagnostic> diagnostics, const Sources& sources);

/// Reports names in such comments that no warning has.
void find_unknown_warnings(const Sources& sources, DiagnosticList& diagnostics);

}  // namespace opentmcl::lang
