// Statements that are rows of the manuals' tables: each row becomes a statement for each module, with steps made from
// the columns. The tables are typed from the manuals, not from firmware/spec, and so are a second opinion on it.
#pragma once

#include "tests/conformance/statement.hpp"
#include "tests/conformance/table_file.hpp"

namespace opentmcl::conformance {

/// Range, access, storage and default of each parameter, and status 3 where a module lacks it.
Statements axis_parameter_statements(const std::vector<TableRow>& rows);
Statements global_parameter_statements(const std::vector<TableRow>& rows);

/// Each command exists in its modules and in no other.
Statements command_statements(const std::vector<TableRow>& rows);
/// Each interrupt can be defined, enabled and disabled, and what bank 3 holds for it.
Statements interrupt_statements(const std::vector<TableRow>& rows);
/// Each port follows its line, or drives it.
Statements io_port_statements(const std::vector<TableRow>& rows);
/// Each operation of the calculating commands.
Statements calculation_statements(const std::vector<TableRow>& rows);
/// Each condition of JC and CALL, holding and not.
Statements condition_statements(const std::vector<TableRow>& rows);
/// Every complete datagram the manuals print.
Statements datagram_statements();

}  // namespace opentmcl::conformance
