// Tables of text: one row a line, tabs between the cells, names of the columns in the first line, # begins a comment.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace opentmcl::conformance {

class TableRow {
 public:
  TableRow(std::vector<std::string> columns, std::vector<std::string> cells)
      : columns_(std::move(columns)), cells_(std::move(cells)) {}

  /// Text of a cell; "-" stands for nothing and comes back empty.
  /// @throws std::runtime_error when there is no such column
  const std::string& operator[](std::string_view column) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::string> cells_;
};

/// @throws std::runtime_error with file and line when the file cannot be read or a row has too few or many cells
std::vector<TableRow> read_table(const std::string& path);

}  // namespace opentmcl::conformance
