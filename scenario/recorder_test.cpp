#include "scenario/recorder.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "scenario/csv.hpp"
#include "scenario/scenario_file.hpp"
#include "scenario/scenario_run.hpp"
#include "scenario/vcd.hpp"

namespace opentmcl::scenario {
namespace {

/// What a scenario with a [record] writes down. @param slice time advances in pieces of this length
std::string recording_of(std::string_view text, Microseconds slice = 1'000'000) {
  const ScenarioFile file = read_scenario(text);
  EXPECT_EQ(format(file.problems, "scenario"), "");
  const Scenario& scenario = file.scenario.value();
  std::string recorded;
  Recorder recorder(scenario.recording, recording_format_of(scenario.recording.file),
                    [&recorded](std::string_view piece) { recorded += piece; });
  VirtualModule module(*scenario.module, {}, scenario.board(), &recorder);
  module.advance_to(module.now());
  ScenarioRun run(scenario, module);
  module.add_actor(run);
  recorder.start(module);
  module.add_actor(recorder);
  while (module.now() < scenario.duration) {
    module.advance_to(std::min(scenario.duration, module.now() + slice));
  }
  recorder.finish(module);
  return recorded;
}

/// A value change dump as a reader finds it: for each signal, by its full name, its values by time.
class Dump {
 public:
  using Values = std::vector<std::pair<std::uint64_t, double>>;

  explicit Dump(const std::string& text) {
    std::istringstream words(text);
    std::string word;
    std::string scope;
    std::uint64_t time = 0;
    while (words >> word) {
      if (word == "$timescale") {
        words >> word >> word;
      } else if (word == "$scope") {
        words >> word >> word;
        scope += word + '.';
      } else if (word == "$upscope") {
        scope.erase(scope.rfind('.', scope.size() - 2) + 1);
      } else if (word == "$var") {
        std::string type;
        std::string width;
        std::string code;
        words >> type >> width >> code >> word;
        names_[code] = scope + word;
      } else if (word.front() == '#') {
        EXPECT_GE(std::stoull(word.substr(1)), time) << "time runs backwards";
        time = std::stoull(word.substr(1));
      } else if (word.front() == '0' || word.front() == '1') {
        values_[name(word.substr(1))].push_back({time, word.front() - '0'});
      } else if (word.front() == 'b' || word.front() == 'r') {
        const std::string digits = word.substr(1);
        std::string code;
        words >> code;
        const double value = word.front() == 'r'
                                 ? std::stod(digits)
                                 : static_cast<double>(static_cast<std::int64_t>(std::stoull(digits, nullptr, 2)));
        values_[name(code)].push_back({time, value});
      }
    }
    EXPECT_EQ(scope, "");
    end_ = time;
  }

  const Values& operator[](const std::string& full_name) const { return values_.at("module." + full_name); }
  std::uint64_t end() const { return end_; }

 private:
  const std::string& name(const std::string& code) const { return names_.at(code); }

  std::map<std::string, std::string> names_;
  std::map<std::string, Values> values_;
  std::uint64_t end_ = 0;
};

constexpr std::uint64_t units_a_millisecond = 10'000'000;  // of 100 ps

TEST(Vcd, TellsWhenAndHowSignalsChanged) {
  const Dump dump(recording_of(R"(
    duration = "10 ms"
    [record]
    file = "x.vcd"
    signals = ["supply_voltage", "left_switch", "left_switch.held_open", "input.3", "inputs", "power"]
    [[event]]
    at = "2.5 ms"
    set = { supply_voltage = "18.5 V", left_switch.held_open = 1 }
    [[event]]
    at = "7 ms"
    set = { input.3 = true }
    power_cycle = true
  )"));
  using Values = Dump::Values;
  EXPECT_EQ(dump["supply_voltage"], (Values{{0, 24}, {25 * units_a_millisecond / 10, 18.5}})) << "at its tick";
  EXPECT_EQ(dump["left_switch"], (Values{{0, 0}, {25 * units_a_millisecond / 10, 1}}));
  EXPECT_EQ(dump["left_switch.held_open"], (Values{{0, 0}, {3 * units_a_millisecond, 1}})) << "when it is looked at";
  EXPECT_EQ(dump["input.3"], (Values{{0, 0}, {7 * units_a_millisecond, 1}}));
  EXPECT_EQ(dump["inputs"], (Values{{0, 0}, {7 * units_a_millisecond, 8}}));
  EXPECT_EQ(dump["power"], (Values{{0, 0}, {7 * units_a_millisecond, 0}, {7 * units_a_millisecond, 1}}));
  EXPECT_EQ(dump.end(), 10 * units_a_millisecond);
}

TEST(Vcd, WritesNumbersOfEverySignAndKind) {
  Vcd vcd;
  const std::vector<RecordedSignal> signals{
      {"position", twin::find_quantity("position")}, {"stage", twin::find_quantity("stage")}, {"tmc262.word", nullptr}};
  std::string text = vcd.begin(signals, 0, std::vector<double>{0, 0, 0});
  text += vcd.change(1, 0, -1);
  text += vcd.change(1, 1, -0.125);
  text += vcd.change(2, 2, 0xFFFFF);
  text += vcd.change(2, 0, 1'234'567);
  text += vcd.end(5);
  const Dump dump(text);
  using Values = Dump::Values;
  EXPECT_EQ(dump["position"], (Values{{0, 0}, {625, -1}, {1250, 1'234'567}}));
  EXPECT_EQ(dump["stage"], (Values{{0, 0}, {625, -0.125}}));
  EXPECT_EQ(dump["tmc262.word"], (Values{{0, 0}, {1250, 0xFFFFF}}));
  EXPECT_EQ(dump.end(), 5u * 625);
}

TEST(Vcd, HasACodeForEachOfManySignals) {
  Vcd vcd;
  const std::vector<RecordedSignal> signals(500, {"position", twin::find_quantity("position")});
  const std::string text = vcd.begin(signals, 0, std::vector<double>(500, 0));
  std::map<std::string, int> codes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("$var")) ++codes[line.substr(16, line.find(' ', 16) - 16)];
  }
  EXPECT_EQ(codes.size(), 500u);
}

TEST(Csv, HasALineForEveryTickAtWhichSomethingChanged) {
  EXPECT_EQ(recording_of(R"(
    duration = "10 ms"
    [record]
    file = "x.csv"
    signals = ["supply_voltage", "input.3", "stage"]
    [[event]]
    at = "2.5 ms"
    set = { supply_voltage = "18.5 V" }
    [[event]]
    at = "7 ms"
    set = { input.3 = true, supply_voltage = "20 V" }
  )"),
            "time [s],supply_voltage [V],input.3,stage [mm]\n0.0,24,0,0\n0.0025,18.5,0,0\n0.007,20,1,0\n0.01,20,1,0\n");
}

TEST(Csv, WritesEveryDigitOfATick) {
  EXPECT_EQ(seconds_text(0), "0.0");
  EXPECT_EQ(seconds_text(1), "0.0000000625");
  EXPECT_EQ(seconds_text(16'000'001), "1.0000000625");
  EXPECT_EQ(seconds_text(24'000'000), "1.5");
}

constexpr std::string_view move = R"(
    duration = "400 ms"
    [[event]]
    at = "100 ms"
    send = "MVP ABS, 0, 3000"
    [record]
    file = "x.vcd"
)";

TEST(Recorder, HasEachStepAtItsTickOrEachValueSoOften) {
  const std::string signals = "signals = [\"encoder\", \"position\"]\n";
  const std::string ideal = "[motor]\nname = \"ideal\"\n";
  const Dump exact(recording_of(std::string(move) + signals + ideal));
  const Dump coarse(recording_of(std::string(move) + signals + "exact = false\nevery = \"20 ms\"\n" + ideal));
  const auto is_at_look = [](const auto& change) { return change.first % (20 * units_a_millisecond) == 0; };
  EXPECT_FALSE(std::all_of(exact["encoder"].begin(), exact["encoder"].end(), is_at_look));
  EXPECT_TRUE(std::all_of(coarse["encoder"].begin(), coarse["encoder"].end(), is_at_look));
  EXPECT_LT(coarse["encoder"].size(), 22u);
  EXPECT_GT(exact["encoder"].size(), 55u);
  EXPECT_EQ(exact["encoder"].back().second, coarse["encoder"].back().second);
}

TEST(Recorder, LooksOftenEnoughAtWhatARealMotorMoves) {
  const Dump dump(recording_of(std::string(move) + "signals = [\"encoder\"]\n"));
  const Dump::Values& counts = dump["encoder"];
  ASSERT_GT(counts.size(), 50u);
  for (const auto& [time, count] : counts) EXPECT_EQ(time % units_a_millisecond, 0u) << time;
  for (std::size_t i = 1; i < counts.size(); ++i) {
    EXPECT_LE(std::abs(counts[i].second - counts[i - 1].second), 2) << "at " << counts[i].first;
  }
}

TEST(Recorder, StartsAtItsConditionWithWhatWasBefore) {
  const std::string text = std::string(move) + "signals = [\"position\", \"encoder\"]\nwhen = \"position > 1000\"\n";
  const Dump all(recording_of(std::string(move) + "signals = [\"position\"]"));
  const Dump::Values& positions = all["position"];
  const auto crossing =
      std::find_if(positions.begin(), positions.end(), [](const auto& change) { return change.second > 1000; });
  ASSERT_NE(crossing, positions.end());

  const Dump triggered(recording_of(text));
  EXPECT_EQ(triggered["position"].front(), *crossing);
  const Dump with_past(recording_of(text + "before = \"10 ms\""));
  EXPECT_EQ(with_past["position"].front().first, crossing->first - 10 * units_a_millisecond);
  EXPECT_EQ(with_past["position"].front().second, (crossing - 10)->second);
  EXPECT_EQ(with_past["position"].size(), triggered["position"].size() + 10);
  EXPECT_EQ(with_past["encoder"].back(), triggered["encoder"].back());
}

TEST(Recorder, WritesNothingWhileItsConditionDoesNotHold) {
  EXPECT_EQ(recording_of(std::string(move) + "signals = [\"position\"]\nwhen = \"position > 5000\""), "");
}

RC_GTEST_PROP(Recorder, WritesTheSameBytesAtEverySpeed, ()) {
  const std::string text = std::string(move) +
                           "signals = [\"position\", \"encoder\", \"step\", \"stage\", \"tmc429.datagram\", "
                           "\"rotor.angle\"]\nwhen = \"position > 50\"\nbefore = \"3 ms\"";
  static const std::string in_one_leap = recording_of(text);
  RC_ASSERT(in_one_leap.size() > 10'000u);
  RC_ASSERT(recording_of(text, *rc::gen::inRange<Microseconds>(500, 200'000)) == in_one_leap);
}

TEST(Recorder, SaysWhichSignalsThereAre) {
  const twin::World free;
  EXPECT_EQ(objection_to_signal("position", free), std::nullopt);
  EXPECT_EQ(objection_to_signal("tmc262.word", free), std::nullopt);
  EXPECT_EQ(objection_to_signal("stage", free), "stage does not exist on this machine");
  EXPECT_EQ(objection_to_signal("tmc262.wrod", free), "there is no signal 'tmc262.wrod': did you mean tmc262.word?");
}

}  // namespace
}  // namespace opentmcl::scenario
