#include "scenario/scenario_run.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenario/scenario_file.hpp"

namespace opentmcl::scenario {
namespace {

using testing::ElementsAre;

/// A scenario that runs on a module of its own.
class Bench {
 public:
  explicit Bench(std::string_view text) : Bench(read_scenario(text)) {}
  explicit Bench(ScenarioFile file)
      : scenario_(std::move(file.scenario.value())), module_(*scenario_.module, {}, scenario_.board(), &trace_) {
    scenario_.write_initial(module_.world());
    module_.advance_to(module_.now());
    run_.emplace(scenario_, module_, [this](const Report& report) {
      if (report.kind == Report::Kind::end && report.time == scenario_.duration) return;
      constexpr const char* kinds[] = {"note", "met", "failed", "end"};
      reports_.push_back(std::to_string(report.time) + ' ' + kinds[static_cast<int>(report.kind)] + ": " + report.text);
    });
    module_.add_actor(*run_);
  }

  /// @param slice time advances in pieces of this length
  void advance_to(Microseconds time, Microseconds slice = 1'000'000) {
    while (module_.now() < time) module_.advance_to(std::min(time, module_.now() + slice));
  }
  void advance_to_the_end(Microseconds slice = 1'000'000) {
    advance_to(scenario_.duration, slice);
    run_->finish(module_);
  }

  double value_of(std::string_view name) const { return twin::find_quantity(name)->read(module_.world()); }
  ScenarioRun& run() { return *run_; }
  const std::vector<std::string>& reports() const { return reports_; }
  const std::string& trace() const { return trace_.text(); }

 private:
  Scenario scenario_;
  twin::TraceText trace_;
  VirtualModule module_;
  std::optional<ScenarioRun> run_;
  std::vector<std::string> reports_;
};

TEST(ScenarioRun, SetsQuantitiesBeforePowerOnAndAtTheirTimes) {
  Bench bench(R"(
    duration = "2 s"
    [initial]
    temperature = 40
    [[event]]
    at = "1.000001 s"
    set = { temperature = 80, input.3 = true }
  )");
  bench.advance_to(1'000'000);
  EXPECT_EQ(bench.value_of("temperature"), 40);
  bench.advance_to(1'000'001);
  EXPECT_EQ(bench.value_of("temperature"), 80);
  EXPECT_EQ(bench.value_of("input.3"), 1);
  EXPECT_THAT(bench.trace(), testing::HasSubstr("\n16000016 temperature 80\n16000016 inputs 8\n"));
}

TEST(ScenarioRun, RepeatsAnEventInItsPeriod) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "10 ms"
    every = "300 ms"
    note = "again"
  )");
  bench.advance_to_the_end();
  EXPECT_THAT(bench.reports(),
              ElementsAre("10000 note: again", "310000 note: again", "610000 note: again", "910000 note: again"));
}

TEST(ScenarioRun, WaitsForAConditionThatHolds) {
  Bench bench(R"(
    duration = "3 s"
    [[event]]
    at = "0.5003 s"
    pulse = { input.0 = 1 }
    lasting = "2 ms"
    [[event]]
    at = "1 s"
    pulse = { input.0 = 1 }
    lasting = "50 ms"
    [[event]]
    when = "input.0"
    note = "high"
    [[event]]
    when = "input.0"
    for = "20 ms"
    note = "high for long"
    [[event]]
    when = "input.0"
    repeat = true
    note = "high again"
  )");
  bench.advance_to_the_end();
  EXPECT_THAT(bench.reports(), ElementsAre("501000 note: high", "501000 note: high again", "1000000 note: high again",
                                           "1020000 note: high for long"));
}

TEST(ScenarioRun, LetsAPulseEndAtTheFormerValue) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "100 ms"
    pulse = { temperature = 90 }
    lasting = "2.5 ms"
  )");
  bench.advance_to(102'499);
  EXPECT_EQ(bench.value_of("temperature"), 90);
  bench.advance_to(102'500);
  EXPECT_EQ(bench.value_of("temperature"), 25);
}

TEST(ScenarioRun, ProlongsAPulseThatComesAgainWhileItLasts) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "100 ms"
    pulse = { temperature = 90 }
    lasting = "30 ms"
    [[event]]
    at = "120 ms"
    pulse = { temperature = 80 }
    lasting = "30 ms"
  )");
  bench.advance_to(120'000);
  EXPECT_EQ(bench.value_of("temperature"), 80);
  bench.advance_to(149'999);
  EXPECT_EQ(bench.value_of("temperature"), 80);
  bench.advance_to(150'000);
  EXPECT_EQ(bench.value_of("temperature"), 25);
}

TEST(ScenarioRun, RampsEvenly) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "100 ms"
    ramp = { supply_voltage = "14 V", temperature = 28 }
    over = "10 ms"
  )");
  bench.advance_to(102'000);
  EXPECT_NEAR(bench.value_of("supply_voltage"), 22, 1e-9);
  EXPECT_EQ(bench.value_of("temperature"), 26) << "whole degrees";
  bench.advance_to(110'000);
  EXPECT_EQ(bench.value_of("supply_voltage"), 14);
  EXPECT_EQ(bench.value_of("temperature"), 28);
}

TEST(ScenarioRun, LetsTheLaterWordCount) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "100 ms"
    ramp = { supply_voltage = "14 V" }
    over = "100 ms"
    [[event]]
    at = "150 ms"
    set = { supply_voltage = "30 V" }
  )");
  bench.advance_to(500'000);
  EXPECT_EQ(bench.value_of("supply_voltage"), 30);
}

TEST(ScenarioRun, SendsCommandsAndReportsThoseThatAreRefused) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "100 ms"
    send = ["SGP 5, 2, 42", "SAP 140, 0, 100"]
    [[expect]]
    at = "200 ms"
    answer_to = "GGP 5, 2"
    is = 42
    [[expect]]
    at = "200 ms"
    answer_to = "GGP 5, 2"
    is = 41
  )");
  bench.advance_to_the_end();
  EXPECT_THAT(bench.reports(), ElementsAre("100000 failed: SAP 140, 0, 100 was answered with status 4",
                                           "200000 met: GGP 5, 2 is 42; the answer is 42",
                                           "200000 failed: GGP 5, 2 is 41; the answer is 42"));
  EXPECT_EQ(bench.run().failures(), 2u);
}

TEST(ScenarioRun, MovesTheMotorByCommand) {
  Bench bench(R"(
    duration = "3 s"
    [[event]]
    at = "100 ms"
    send = "MVP ABS, 0, 25600"
    [[event]]
    when = "stage > 0.5 mm"
    note = "half way"
    [[expect]]
    at = "3 s"
    that = "stage = 1 mm within 0.002 mm and position = target_position"
  )");
  bench.advance_to_the_end();
  ASSERT_EQ(bench.reports().size(), 2u);
  EXPECT_THAT(bench.reports()[0], testing::EndsWith(" note: half way"));
  // A motor stands within its friction of where its field is.
  EXPECT_THAT(
      bench.reports()[1],
      testing::MatchesRegex("3000000 met: stage = 1 mm within 0.002 mm and position = target_position; stage is "
                            "(1|0.999) mm, position is 25600, target_position is 25600"));
}

TEST(ScenarioRun, TellsWhichExpectationsAreNotMet) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "500 ms"
    pulse = { input.0 = 1 }
    lasting = "3 ms"
    [[expect]]
    at = "100 ms"
    that = "input.0"
    [[expect]]
    by = "900 ms"
    that = "input.0"
    [[expect]]
    by = "900 ms"
    that = "input.1"
  )");
  bench.advance_to_the_end();
  EXPECT_THAT(bench.reports(), ElementsAre("100000 failed: input.0; input.0 is 0", "500000 met: input.0; input.0 is 1",
                                           "900000 failed: input.1; input.1 is 0"));
  EXPECT_EQ(bench.run().failures(), 2u);
}

TEST(ScenarioRun, EndsEarlyAndLeavesNoExpectationUndecided) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "100 ms"
    end = true
    [[event]]
    at = "200 ms"
    note = "never"
    [[expect]]
    at = "900 ms"
    that = "not input.0"
  )");
  bench.advance_to_the_end();
  EXPECT_TRUE(bench.run().has_ended());
  EXPECT_THAT(bench.reports(),
              ElementsAre("100000 end: the end", "1000000 failed: the run ended before this was looked at"));
}

TEST(ScenarioRun, TakesTheSupplyAwayAndGivesItBack) {
  Bench bench(R"(
    duration = "1 s"
    [[event]]
    at = "100 ms"
    send = "SGP 5, 2, 42"
    [[event]]
    at = "200 ms"
    power_cycle = true
    [[expect]]
    at = "300 ms"
    answer_to = "GGP 5, 2"
  )");
  bench.advance_to_the_end();
  EXPECT_THAT(bench.reports(), ElementsAre("300000 met: GGP 5, 2 is 0; the answer is 0"));
}

constexpr std::string_view busy_scenario = R"(
    duration = "1 s"
    [machine]
    start = "-47.9 mm"
    [[event]]
    at = "10 ms"
    send = ["SAP 13, 0, 0", "ROL 0, 1500"]
    [[event]]
    when = "left_switch"
    for = "5 ms"
    ramp = { supply_voltage = "18 V" }
    over = "33 ms"
    send = "ROR 0, 1000"
    repeat = true
    [[event]]
    at = "3.7 ms"
    every = "7.3 ms"
    pulse = { "home_switch.held_open" = 1 }
    lasting = "3.1 ms"
    [[event]]
    when = "position > 5000 or stage > -45 mm"
    power_cycle = true
)";

TEST(ScenarioRun, IsTheSameAtEverySpeed) {
  const auto trace_in_slices_of = [](Microseconds slice) {
    Bench bench(busy_scenario);
    bench.advance_to_the_end(slice);
    return bench.trace();
  };
  const std::string in_one_leap = trace_in_slices_of(1'000'000);
  EXPECT_GT(in_one_leap.size(), 10'000u);
  for (const Microseconds slice : {Microseconds{333}, Microseconds{1'000}, Microseconds{10'001}}) {
    EXPECT_TRUE(trace_in_slices_of(slice) == in_one_leap) << slice;
  }
}

}  // namespace
}  // namespace opentmcl::scenario
