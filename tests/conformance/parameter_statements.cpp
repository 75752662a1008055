#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "tests/conformance/table_statements.hpp"

namespace opentmcl::conformance {

namespace {

/// The manual's four commands for one kind of parameter, and what stands between the number and the value.
struct Kind {
  const char* name;
  const char* section;
  const char* get;
  const char* set;
  const char* store;
  const char* restore;
  const char* from_accumulator;
};

constexpr Kind axis_kind{"axis parameter", "4", "GAP", "SAP", "STAP", "RSAP", "AAP"};
constexpr Kind global_kind{"global parameter", "5.1", "GGP", "SGP", "STGP", "RSGP", "AGP"};

struct Interval {
  std::int64_t minimum;
  std::int64_t maximum;
};

constexpr Interval every_number{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()};

std::vector<Interval> parse_intervals(const std::string& text) {
  if (text == "int32") return {every_number};
  std::vector<Interval> intervals;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t dots = word.find("..");
    if (dots == std::string::npos) throw std::runtime_error("expected minimum..maximum, found " + word);
    intervals.push_back({std::stoll(word.substr(0, dots)), std::stoll(word.substr(dots + 2))});
  }
  return intervals;
}

/// One module's columns of a row.
struct Column {
  std::string access;
  std::string range;
  std::string default_value;
  bool default_is_decided = false;

  bool allows(char letter) const { return access.find(letter) != std::string::npos; }
};

Column column_of(const TableRow& row, const std::string& prefix) {
  Column column{row[prefix + "_access"], row[prefix + "_range"], row[prefix + "_default"]};
  if (!column.default_value.empty() && column.default_value.back() == '?') {
    column.default_value.pop_back();
    column.default_is_decided = true;
  }
  return column;
}

class Steps {
 public:
  Steps(const Kind& kind, const std::string& number) : kind_(kind), number_(number) {}

  void add(const std::string& line) { text_ += line + '\n'; }
  void get(const std::string& reply) { add(std::string(kind_.get) + ' ' + number_ + ", 0 -> " + reply); }
  void set(std::int64_t value, const std::string& reply) {
    add(std::string(kind_.set) + ' ' + number_ + ", 0, " + std::to_string(value) + " -> " + reply);
  }
  void command(const char* mnemonic, const std::string& reply) {
    add(std::string(mnemonic) + ' ' + number_ + ", 0 -> " + reply);
  }
  void writes_and_reads_back(std::int64_t value) {
    set(value, "100");
    get("100, " + std::to_string(value));
  }

  const std::string& text() const { return text_; }

 private:
  const Kind& kind_;
  const std::string& number_;
  std::string text_;
};

void add_range(Steps& steps, const std::vector<Interval>& intervals) {
  const auto is_inside = [&intervals](std::int64_t value) {
    return std::any_of(intervals.begin(), intervals.end(), [value](const Interval& interval) {
      return interval.minimum <= value && value <= interval.maximum;
    });
  };
  for (const Interval& interval : intervals) {
    steps.writes_and_reads_back(interval.minimum);
    steps.writes_and_reads_back(interval.maximum);
    for (const std::int64_t outside : {interval.minimum - 1, interval.maximum + 1}) {
      const bool can_be_sent = every_number.minimum <= outside && outside <= every_number.maximum;
      if (is_inside(outside) || !can_be_sent) continue;
      steps.set(outside, "4");
      steps.get("100, " + std::to_string(interval.maximum));  // a refused value changes nothing
    }
  }
}

void add_storage(Steps& steps, const Kind& kind, const Column& column, std::int64_t stored) {
  const std::string stored_reply = "100, " + std::to_string(stored);
  if (column.allows('E')) {
    const std::int64_t other = std::stoll(column.default_value);
    steps.set(stored, "100");
    steps.command(kind.store, "100");
    steps.writes_and_reads_back(other);
    steps.command(kind.restore, "100");
    steps.get(stored_reply);
    steps.writes_and_reads_back(other);
    steps.add("power cycle");
    steps.get(stored_reply);
  } else if (column.allows('A')) {
    steps.writes_and_reads_back(stored);
    steps.add("power cycle");
    steps.get(stored_reply);
  } else {
    steps.command(kind.store, "3");
    steps.command(kind.restore, "3");
    if (column.default_value.empty()) return;
    steps.add("power cycle");
    steps.get("100, " + column.default_value);
  }
}

void add_writing(Steps& steps, const Kind& kind, const Column& column, const TableRow& row) {
  const std::vector<Interval> intervals = parse_intervals(column.range);
  if (!column.allows('W')) {
    steps.set(0, "3");
    steps.command(kind.from_accumulator, "3");
    steps.command(kind.store, "3");
    steps.command(kind.restore, "3");
  } else if (!intervals.empty()) {
    add_range(steps, intervals);
    const std::int64_t value = row["stored"].empty() ? intervals.front().maximum : std::stoll(row["stored"]);
    steps.add("CALC LOAD, " + std::to_string(value) + " -> 100");
    steps.command(kind.from_accumulator, "100");
    steps.get("100, " + std::to_string(value));
    add_storage(steps, kind, column, value);
  }
}

std::string capitalised(std::string text) {
  text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text;
}

Statements statements_of(const Kind& kind, const TableRow& row, const std::string& prefix, Modules module) {
  const std::string& number = row["number"];
  const Column column = column_of(row, prefix);
  std::string id = std::string(kind.name) + ' ' + number;
  std::replace(id.begin(), id.end(), ' ', '-');
  const std::string subject = capitalised(kind.name) + ' ' + number + ", " + row["name"] + ", ";

  Steps steps(kind, number);
  if (column.access.empty()) {
    steps.get("3");
    steps.set(0, "3");
    steps.command(kind.from_accumulator, "3");
    steps.command(kind.store, "3");
    steps.command(kind.restore, "3");
    return {
        {id + "-absent", kind.section, subject + "does not exist.", module, hal::PortKind::usb, "", "", steps.text()}};
  }

  Statements statements;
  if (!column.default_value.empty()) {
    Steps after_power_on(kind, number);
    after_power_on.get("100, " + column.default_value);
    statements.push_back({id + "-default", kind.section, subject + "starts as " + column.default_value + '.', module,
                          hal::PortKind::usb, column.default_is_decided ? "0004" : "", "", after_power_on.text()});
  }
  if (&kind == &axis_kind) {
    const std::string& before = row["before"];
    if (!before.empty()) steps.add(before + " -> 100");
    steps.add(std::string(kind.get) + ' ' + number + ", 1 -> 4");  // a motor the module does not have
  }
  steps.get("100");
  add_writing(steps, kind, column, row);
  const std::string range = column.range.empty() ? "" : ", takes " + column.range;
  statements.push_back({id, kind.section, subject + "has access " + column.access + range + '.', module,
                        hal::PortKind::usb, "", "", steps.text()});
  return statements;
}

/// Numbers no row names: unknown to both modules.
Statement unknown_numbers(const Kind& kind, const std::vector<TableRow>& rows) {
  std::string steps;
  for (int number = 0; number < 256; ++number) {
    const std::string text = std::to_string(number);
    const bool is_known =
        std::any_of(rows.begin(), rows.end(), [&](const TableRow& row) { return row["number"] == text; });
    if (is_known) continue;
    steps += fmt::format("{0} {2}, 0 -> 3\n{1} {2}, 0, 0 -> 3\n", kind.get, kind.set, text);
  }
  std::string id = std::string("no-other-") + kind.name;
  std::replace(id.begin(), id.end(), ' ', '-');
  return {id, kind.section, "No other " + std::string(kind.name) + " exists.", Modules::both, hal::PortKind::usb, "",
          "", steps};
}

Statements parameter_statements(const Kind& kind, const std::vector<TableRow>& rows) {
  Statements statements;
  for (const TableRow& row : rows) {
    for (const auto& [prefix, module] : {std::pair{"pd", Modules::pd1161}, std::pair{"tm", Modules::tmcm1110}}) {
      for (Statement& statement : statements_of(kind, row, prefix, module)) statements.push_back(std::move(statement));
    }
  }
  statements.push_back(unknown_numbers(kind, rows));
  return statements;
}

}  // namespace

Statements axis_parameter_statements(const std::vector<TableRow>& rows) {
  return parameter_statements(axis_kind, rows);
}

Statements global_parameter_statements(const std::vector<TableRow>& rows) {
  return parameter_statements(global_kind, rows);
}

}  // namespace opentmcl::conformance
