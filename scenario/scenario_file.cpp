#include "scenario/scenario_file.hpp"

#include <toml++/toml.h>

#include <utility>

#include "lang/diagnostic.hpp"
#include "scenario/bench_reader.hpp"
#include "scenario/recorder.hpp"
#include "scenario/section.hpp"
#include "scenario/section_reader.hpp"
#include "scenario/toml_place.hpp"
#include "scenario/value_reader.hpp"

namespace opentmcl::scenario {
namespace {

class Reader {
 public:
  ScenarioFile read(const toml::table& file) {
    Scenario scenario;
    std::vector<std::string_view> section_names;
    for (const SectionName& known : sections()) section_names.push_back(known.name);
    read_section(values_, file, root_keys(), scenario, "the scenario", section_names);
    if (const toml::node* const program = file.get(program_key)) scenario.program_place = place_of(*program);
    static_cast<BenchSetup&>(scenario) = bench_.read(file, *scenario.module);
    if (const toml::table* const table = section(file, record_section)) {
      read_section(values_, *table, record_keys(), scenario.recording, "[record]");
      check(*table, scenario.recording);
    }
    for (const toml::table* const table : rows(file, event_section)) {
      Event& event = scenario.events.emplace_back();
      event.place = place_of(*table);
      const std::size_t problems_before = problems_.size();
      read_section(values_, *table, event_keys(), event, "[[event]]");
      if (problems_.size() == problems_before) check(*table, event, scenario.duration);
    }
    for (const toml::table* const table : rows(file, expect_section)) {
      Expectation& expectation = scenario.expectations.emplace_back();
      expectation.place = place_of(*table);
      const std::size_t problems_before = problems_.size();
      read_section(values_, *table, expect_keys(), expectation, "[[expect]]");
      if (problems_.size() == problems_before) check(*table, expectation, scenario.duration);
    }
    if (problems_.size() > 0) return {std::nullopt, problems_.take_sorted()};
    return {std::move(scenario), {}};
  }

 private:
  void complain(Place place, std::string message) { problems_.complain(place, std::move(message)); }

  // ---- Sections

  const toml::table* section(const toml::table& file, std::string_view name) {
    const toml::node* const node = file.get(name);
    if (node == nullptr) return nullptr;
    if (!node->is_table()) values_.complain_of_kind(*node, "the section [" + std::string(name) + "]");
    return node->as_table();
  }

  std::vector<const toml::table*> rows(const toml::table& file, std::string_view name) {
    const toml::node* const node = file.get(name);
    if (node == nullptr) return {};
    const std::string expected = "[[" + std::string(name) + "]]";
    std::vector<const toml::table*> tables;
    if (const toml::array* const array = node->as_array()) {
      for (const toml::node& row : *array) {
        if (row.is_table()) tables.push_back(row.as_table());
        if (!row.is_table()) values_.complain_of_kind(row, expected);
      }
    } else {
      complain(place_of(*node), "there can be several of these: expected " + expected);
    }
    return tables;
  }

  // ---- What fits together

  void check(const toml::table& table, const Recording& recording) {
    if (!recording.file.empty() && !recording_format_of(recording.file)) {
      complain(place_of(*table.get("file")),
               "expected a name that ends in .vcd or .csv, found " + lang::in_quotes(recording.file));
    }
    need(table, "before", "when");
  }

  void check(const toml::table& table, const Event& event, Microseconds duration) {
    exactly_one_of(table, "[[event]]", "at", "when");
    need(table, "every", "at");
    need(table, "for", "when");
    need(table, "repeat", "when");
    need(table, "lasting", "pulse");
    need(table, "pulse", "lasting");
    need(table, "over", "ramp");
    need(table, "ramp", "over");
    check_time(table, "at", event.at, duration);
    if (table.contains("every") && event.every < one_millisecond) {
      complain(place_of(*table.get("every")), "expected at least 1 ms");
    }
    const bool acts = !event.set.empty() || !event.pulse.empty() || !event.ramp.empty() || !event.send.empty() ||
                      event.power_cycle || event.end || !event.note.empty();
    if (!acts) {
      complain(place_of(table),
               "nothing happens in this [[event]]: expected set, pulse, ramp, send, power_cycle, note or end");
    }
  }

  void check(const toml::table& table, const Expectation& expectation, Microseconds duration) {
    exactly_one_of(table, "[[expect]]", "at", "by");
    exactly_one_of(table, "[[expect]]", "that", "answer_to");
    need(table, "is", "answer_to");
    need(table, "answer_to", "at");
    check_time(table, "at", expectation.at, duration);
    check_time(table, "by", expectation.by, duration);
  }

  void exactly_one_of(const toml::table& table, std::string_view section, std::string_view first,
                      std::string_view second) {
    const bool both = table.contains(first) && table.contains(second);
    const bool none = !table.contains(first) && !table.contains(second);
    if (!both && !none) return;
    complain(place_of(table), std::string(section) + (both ? " has both " : " has neither ") + std::string(first) +
                                  (both ? " and " : " nor ") + std::string(second) + ": expected one of them");
  }

  void need(const toml::table& table, std::string_view key, std::string_view other) {
    if (!table.contains(key) || table.contains(other)) return;
    complain(place_of(*table.get(key)),
             std::string(key) + " means nothing without " + std::string(other) + ": expected both or none");
  }

  void check_time(const toml::table& table, std::string_view key, std::optional<Microseconds> time,
                  Microseconds duration) {
    if (!time || duration == 0 || *time <= duration) return;
    complain(place_of(*table.get(key)),
             "this is after the end: the duration is " + twin::text_of(static_cast<double>(duration) / 1e6) + " s");
  }

  ProblemList problems_;
  ValueReader values_{problems_};
  BenchReader bench_{problems_, values_};
};

}  // namespace

ScenarioFile read_scenario(std::string_view text) {
  try {
    return Reader().read(toml::parse(text));
  } catch (const toml::parse_error& error) {
    return {std::nullopt, {{place_of(error.source()), description_of(error)}}};
  }
}

std::string format(const std::vector<Problem>& problems, std::string_view file_name) {
  std::string text;
  for (const Problem& problem : problems) {
    text += std::string(file_name) + ':' + std::to_string(problem.place.line) + ':' +
            std::to_string(problem.place.column) + ": " + problem.message + '\n';
  }
  return text;
}

}  // namespace opentmcl::scenario
