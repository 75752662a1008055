#include "tests/conformance/table_file.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace opentmcl::conformance {

namespace {

std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(line.find('\t', begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
    if (cells.back() == "-") cells.back().clear();
    if (end == line.size()) return cells;
    begin = end + 1;
  }
}

}  // namespace

const std::string& TableRow::operator[](std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) throw std::runtime_error("no column is called " + std::string(column));
  return cells_[static_cast<std::size_t>(found - columns_.begin())];
}

std::vector<TableRow> read_table(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be opened");
  std::vector<TableRow> rows;
  std::vector<std::string> columns;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> cells = split_cells(line);
    if (columns.empty()) {
      columns = std::move(cells);
      continue;
    }
    if (cells.size() != columns.size()) {
      throw std::runtime_error(path + ':' + std::to_string(number) + ": expected " + std::to_string(columns.size()) +
                               " cells, found " + std::to_string(cells.size()));
    }
    rows.emplace_back(columns, std::move(cells));
  }
  return rows;
}

}  // namespace opentmcl::conformance
