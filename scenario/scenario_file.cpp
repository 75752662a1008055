#include "scenario/scenario_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "lang/diagnostic.hpp"
#include "lang/suggestion.hpp"
#include "scenario/recorder.hpp"
#include "scenario/section.hpp"
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
    read_section(file, root_keys(), scenario, "the scenario", section_names);
    // What follows depends on the module and the machine.
    if (const toml::table* const table = section(file, machine_section)) read_machine(*table, scenario.machine);
    if (const toml::table* const table = section(file, encoder_section)) {
      const std::size_t problems_before = problems_.size();
      read_section(*table, encoder_keys(), scenario.encoder, "[encoder]");
      check(*table, scenario.encoder);
      if (problems_.size() != problems_before) scenario.encoder = {};
    }
    if (const toml::table* const table = section(file, motor_section)) read_motor(*table, scenario.motor);
    values_.set_bench(scenario);

    if (const toml::table* const table = section(file, load_section))
      scenario.initial = values_.assignments(*table, load_prefix);
    if (const toml::table* const table = section(file, initial_section)) {
      for (const Assignment& one : values_.assignments(*table)) scenario.initial.push_back(one);
    }
    if (const toml::table* const table = section(file, record_section)) {
      read_section(*table, record_keys(), scenario.recording, "[record]");
      check(*table, scenario.recording);
    }
    for (const toml::table* const table : rows(file, event_section)) {
      Event& event = scenario.events.emplace_back();
      event.place = place_of(*table);
      const std::size_t problems_before = problems_.size();
      read_section(*table, event_keys(), event, "[[event]]");
      if (problems_.size() == problems_before) check(*table, event, scenario.duration);
    }
    for (const toml::table* const table : rows(file, expect_section)) {
      Expectation& expectation = scenario.expectations.emplace_back();
      expectation.place = place_of(*table);
      const std::size_t problems_before = problems_.size();
      read_section(*table, expect_keys(), expectation, "[[expect]]");
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

  /// @param elsewhere names that may stand there too, but are read by somebody else
  template <class Target>
  void read_section(const toml::table& table, std::span<const Key<Target>> keys, Target& target, std::string_view name,
                    const std::vector<std::string_view>& elsewhere = {}) {
    for (const auto& [key, node] : table) {
      const std::string_view word = key.str();
      if (std::find(elsewhere.begin(), elsewhere.end(), word) != elsewhere.end()) continue;
      const auto found =
          std::find_if(keys.begin(), keys.end(), [word](const Key<Target>& row) { return row.name == word; });
      if (found == keys.end()) {
        std::vector<std::string_view> known = elsewhere;
        for (const Key<Target>& row : keys) known.push_back(row.name);
        complain(place_of(key.source()),
                 std::string(name) + " has no " + lang::in_quotes(word) + ": " + nearest(word, known));
      } else if (std::optional<Value> value =
                     values_.read(node, found->type, {found->unit, found->lowest, found->highest, found->choices})) {
        found->store(target, std::move(*value));
      }
    }
    for (const Key<Target>& key : keys) {
      if (key.required && !table.contains(key.name)) {
        complain(place_of(table),
                 std::string(name) + " lacks " + std::string(key.name) + ": " + std::string(key.description));
      }
    }
  }

  static std::string nearest(std::string_view word, const std::vector<std::string_view>& known) {
    lang::Suggestion suggestion(word);
    for (const std::string_view name : known) suggestion.consider(name);
    const std::string hint = suggestion.text();
    return hint.empty() ? "expected " + listed(known) : hint;
  }

  // ---- What fits together

  void read_machine(const toml::table& table, twin::MachineDimensions& machine) {
    const std::size_t problems_before = problems_.size();
    std::vector<std::string_view> kinds;
    for_each_machine_kind([&kinds](const MachineKind& kind, auto, auto) { kinds.push_back(kind.name); });
    std::string_view wanted = kinds.front();
    std::optional<Value> given;
    if (const toml::node* const node = table.get(machine_kind_key)) {
      given = values_.read(*node, ValueType::choice, {.choices = kinds});
      if (!given) return;
      wanted = given->text;
    }
    for_each_machine_kind([&](const MachineKind& kind, auto keys, auto dimensions) {
      if (kind.name != wanted) return;
      read_section(table, keys, dimensions, "[machine] of kind " + std::string(kind.name), {machine_kind_key});
      check(table, dimensions);
      if (problems_.size() == problems_before) machine = dimensions;
    });
  }

  void read_motor(const toml::table& table, std::optional<twin::MotorData>& motor) {
    const std::vector<std::string_view> names = motor_names();
    if (const toml::node* const node = table.get(motor_name_key)) {
      const std::optional<Value> given = values_.read(*node, ValueType::choice, {.choices = names});
      if (!given) return;
      const twin::MotorData* const found = twin::find_motor(given->text);
      motor = found == nullptr ? std::nullopt : std::optional(*found);
    }
    if (motor) {
      read_section(table, motor_keys(), *motor, "[motor]", {motor_name_key});
      return;
    }
    for (const auto& [key, node] : table) {
      if (key.str() == motor_name_key) continue;
      complain(place_of(key.source()),
               "an ideal motor has no " + lang::in_quotes(key.str()) + ": its rotor is always where the field is");
    }
  }

  void check(const toml::table& table, const twin::LinearStageDimensions& stage) {
    const auto check_place = [&](std::string_view key, std::int32_t place) {
      if (2 * std::abs(place) <= stage.travel) return;
      const toml::node* const node = table.get(key);
      complain(place_of(node == nullptr ? table : *node), std::string(key) + " lies beyond a hard end: the travel is " +
                                                              twin::text_of(stage.travel / 1000.0) +
                                                              " mm, half of it on either side of 0");
    };
    check_place("start", stage.start);
    check_place("home_switch_center", stage.home_switch_center);
  }

  // These two can be anything within the ranges of their keys.
  static void check(const toml::table&, const twin::CircularAxisDimensions&) {}
  static void check(const toml::table&, const twin::RotaryAxisDimensions&) {}

  void check(const toml::table& table, const twin::EncoderProperties& encoder) {
    constexpr std::int32_t counts_a_line = 4;
    const auto check_count = [&](std::string_view key, std::int32_t count) {
      if (count < encoder.lines * counts_a_line) return;
      const toml::node* const node = table.get(key);
      complain(place_of(node == nullptr ? table : *node), std::string(key) + " must be less than a turn, which has " +
                                                              std::to_string(encoder.lines * counts_a_line) +
                                                              " counts");
    };
    check_count("null_position", encoder.null_position);
    check_count("null_width", encoder.null_width);
  }

  void check(const toml::table& table, const Recording& recording) {
    if (!recording.file.empty() && !recording_format_of(recording.file)) {
      complain(place_of(*table.get("file")),
               "expected a name that ends in .vcd or .csv, found " + lang::in_quotes(recording.file));
    }
    if (recording.every == 0) complain(place_of(*table.get("every")), "expected a time greater than 0");
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
};

}  // namespace

std::vector<Problem> ProblemList::take_sorted() {
  std::stable_sort(problems_.begin(), problems_.end(), [](const Problem& left, const Problem& right) {
    return std::tie(left.place.line, left.place.column) < std::tie(right.place.line, right.place.column);
  });
  return std::move(problems_);
}

ScenarioFile read_scenario(std::string_view text) {
  try {
    return Reader().read(toml::parse(text));
  } catch (const toml::parse_error& error) {
    return {std::nullopt, {{place_of(error.source()), std::string(error.description())}}};
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
