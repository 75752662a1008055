#include "scenario/scenario_file.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace opentmcl::scenario {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Scenario scenario_in(std::string_view text) {
  ScenarioFile file = read_scenario(text);
  EXPECT_EQ(format(file.problems, "scenario"), "");
  return file.scenario.value_or(Scenario{});
}

/// Of a file whose first line is the one that every scenario needs.
std::string problems_in(std::string_view text) {
  return format(read_scenario("duration = \"10 s\"\n" + std::string(text)).problems, "f");
}

TEST(ScenarioFile, SaysWhatThereIsAndWhatHappens) {
  const Scenario scenario = scenario_in(R"(
    module = "tmcm1110"
    program = "go.tmc"
    duration = "2 min"

    [machine]
    pitch = "5 mm"
    start = -40
    mirrored = true
    contact = "normally open"
    switch_bounce = "2.5 ms"

    [encoder]
    lines = 500

    [initial]
    supply_voltage = "12 V"
    input.3 = true

    [record]
    file = "go.vcd"
    signals = ["position", "power"]
    every = "5 ms"
    when = "position > 7"
    before = "1 s"

    [[event]]
    at = "2.5 s"
    set = { temperature = 80, left_switch.held_open = 1 }
    ramp = { supply_voltage = "18 V" }
    over = "100 ms"

    [[event]]
    when = "stage > 40 mm and velocity > 0"
    for = "20 ms"
    repeat = true
    pulse = { "home_switch.held_open" = 1 }
    lasting = "30 ms"
    send = ["ROR 0, 500", "SIO 1, 2, 1"]
    note = "there"

    [[expect]]
    at = "3 s"
    that = "stage = 40 within 0.1 mm"

    [[expect]]
    at = "4 s"
    answer_to = "GAP 1, 0"
    is = -5
  )");
  EXPECT_EQ(scenario.module, &tmcm1110);
  EXPECT_EQ(scenario.program, "go.tmc");
  EXPECT_EQ(scenario.program_place.line, 3u);
  EXPECT_EQ(scenario.program_place.column, 15u);
  EXPECT_EQ(scenario.duration, 120'000'000u);
  const auto& stage = std::get<twin::LinearStageDimensions>(scenario.machine);
  EXPECT_EQ(stage.pitch, 5'000);
  EXPECT_EQ(stage.start, -40'000);
  EXPECT_TRUE(stage.mirrored);
  EXPECT_EQ(stage.contact, twin::Contact::normally_open);
  EXPECT_EQ(stage.switch_bounce, 2'500);
  EXPECT_EQ(scenario.encoder.lines, 500);
  ASSERT_EQ(scenario.initial.size(), 2u);
  EXPECT_EQ(scenario.initial[0].quantity->name, "supply_voltage");
  EXPECT_EQ(scenario.initial[0].value, 12);
  EXPECT_EQ(scenario.initial[1].quantity->name, "input.3");
  EXPECT_THAT(scenario.recording.signals, ElementsAre("position", "power"));
  EXPECT_EQ(scenario.recording.every, 5'000u);
  EXPECT_EQ(scenario.recording.before, 1'000'000u);

  ASSERT_EQ(scenario.events.size(), 2u);
  const Event& first = scenario.events[0];
  EXPECT_EQ(first.at, Microseconds{2'500'000});
  EXPECT_EQ(first.set.size(), 2u);
  EXPECT_EQ(first.ramp.at(0).value, 18);
  EXPECT_EQ(first.over, 100'000u);
  const Event& second = scenario.events[1];
  EXPECT_EQ(second.when->text, "stage > 40 mm and velocity > 0");
  EXPECT_EQ(second.held_for, 20'000u);
  EXPECT_TRUE(second.repeat);
  EXPECT_EQ(second.pulse.at(0).quantity->name, "home_switch.held_open");
  EXPECT_EQ(second.lasting, 30'000u);
  EXPECT_EQ(second.send.at(0).command, (Command{1, 0, 0, 500}));
  EXPECT_EQ(second.note, "there");
  ASSERT_EQ(scenario.expectations.size(), 2u);
  EXPECT_EQ(scenario.expectations[0].place.line, 42u);
  EXPECT_EQ(scenario.expectations[1].is, -5);
}

TEST(ScenarioFile, FindsAllMistakesAtTheirPlacesInOneRun) {
  EXPECT_EQ(format(read_scenario(R"(module = "pd1116"
durration = "5 s"
[machine]
pitsh = "2 mm"
travel = "2 m3"
[[event]]
at = "3 s"
set = { suply_voltage = 18 }
[[event]]
when = "position > 5 and stge < 3"
set = { supply_voltage = "80 V", temperature = "20 V" }
send = "RORR 0, 500"
[[expect]]
at = 3
that = "stage < 3 V"
)")
                       .problems,
                   "f.toml"),
            R"(f.toml:1:1: the scenario lacks duration: The run is over after this much simulated time.
f.toml:1:10: expected tmcm1110 or pd1161, found 'pd1116'; did you mean pd1161?
f.toml:2:1: the scenario has no 'durration': did you mean duration?
f.toml:4:1: [machine] of kind stage has no 'pitsh': did you mean pitch?
f.toml:5:13: 'm3' is not the unit of a length: expected a length such as 1.5 mm; did you mean mm?
f.toml:8:9: there is no quantity 'suply_voltage': did you mean supply_voltage?
f.toml:10:26: there is no quantity 'stge': did you mean stage?
f.toml:11:26: supply_voltage goes from 0 to 60 V
f.toml:11:52: 'V' is not the unit of a temperature: expected a temperature such as 1.5 degC
f.toml:12:9: there is no instruction 'RORR': did you mean ROR?
f.toml:14:6: expected a time such as "2.5 s" or "30 ms"
f.toml:15:19: 'V' is not the unit of a length: expected a length such as 1.5 mm
)");
}

TEST(ScenarioFile, HasOneProblemWhenItIsNotToml) {
  const std::string problems = format(read_scenario("duration = \"10 s\"\nmodule = \n").problems, "f");
  EXPECT_THAT(problems, HasSubstr("f:2:10: "));
  EXPECT_EQ(std::count(problems.begin(), problems.end(), '\n'), 1);
  EXPECT_EQ(format(read_scenario("duration = \"10 s\nmodule = \"pd1161\"\n").problems, "f"),
            "f:1:17: the text does not end in its line: expected a quote\n");
}

TEST(ScenarioFile, KnowsWhatBelongsTogether) {
  EXPECT_EQ(problems_in("[[event]]\nnote = \"x\""), "f:2:1: [[event]] has neither at nor when: expected one of them\n");
  EXPECT_EQ(problems_in("[[event]]\nat = \"1 s\"\nwhen = \"input.0\"\nnote = \"x\""),
            "f:2:1: [[event]] has both at and when: expected one of them\n");
  EXPECT_EQ(problems_in("[[event]]\nat = \"1 s\"\nfor = \"1 s\"\nnote = \"x\""),
            "f:4:7: for means nothing without when: expected both or none\n");
  EXPECT_EQ(problems_in("[[event]]\nat = \"1 s\"\npulse = { input.0 = 1 }"),
            "f:4:9: pulse means nothing without lasting: expected both or none\n");
  EXPECT_EQ(problems_in("[[event]]\nat = \"11 s\"\nnote = \"x\""),
            "f:3:6: this is after the end: the duration is 10 s\n");
  EXPECT_THAT(problems_in("[[event]]\nat = \"1 s\""), HasSubstr("f:2:1: nothing happens in this [[event]]"));
  EXPECT_THAT(problems_in("[[event]]\nat = \"1 s\"\nevery = \"10 us\"\nnote = \"x\""),
              HasSubstr("f:4:9: expected at least 1 ms"));
  EXPECT_EQ(problems_in("[[expect]]\nat = \"1 s\""),
            "f:2:1: [[expect]] has neither that nor answer_to: expected one of them\n");
  EXPECT_EQ(problems_in("[[expect]]\nby = \"1 s\"\nanswer_to = \"GAP 1, 0\""),
            "f:4:13: answer_to means nothing without at: expected both or none\n");
  EXPECT_EQ(problems_in("[machine]\nkind = \"free\"\npitch = 3"),
            "f:4:1: [machine] of kind free has no 'pitch': expected kind, inertia or friction\n");
  EXPECT_EQ(problems_in("module = \"tmcm1110\"\n[encoder]\nlines = 100\nnull_position = 400"),
            "f:5:17: null_position must be less than a turn, which has 400 counts\n");
  EXPECT_EQ(problems_in("[machine]\nkind = \"circle\""), "f:3:8: expected stage, circular or free, found 'circle'\n");
  EXPECT_EQ(problems_in("[machine]\nstart = \"60 mm\""),
            "f:3:9: start lies beyond a hard end: the travel is 100 mm, half of it on either side of 0\n");
  EXPECT_EQ(format(read_scenario("duration = \"0 s\"").problems, "f"), "f:1:12: expected a time greater than 0\n");
  EXPECT_EQ(problems_in("[initial]\ninput.3 = \"yes\""), "f:3:11: expected true or false, found a text\n");
  EXPECT_EQ(problems_in("event = 5"), "f:2:9: there can be several of these: expected [[event]]\n");
  EXPECT_EQ(problems_in("machine = 5"), "f:2:11: expected the section [machine] or a name, found a number\n");
}

TEST(ScenarioFile, KnowsWhatTheMachineHas) {
  EXPECT_EQ(problems_in("[machine]\nkind = \"free\"\n[[event]]\nwhen = \"position > 1 and stage > 1\"\nnote = \"x\""),
            "f:5:26: stage does not exist on this machine\n");
  EXPECT_EQ(problems_in("[initial]\nposition = 5"), "f:3:1: position can only be looked at\n");
  EXPECT_EQ(problems_in("[record]\nfile = \"x.vcd\"\nsignals = [\"position\", \"stpe\"]"),
            "f:4:24: there is no signal 'stpe': did you mean step?\n");
  EXPECT_EQ(problems_in("[record]\nfile = \"x.wav\"\nsignals = []"),
            "f:3:8: expected a name that ends in .vcd or .csv, found 'x.wav'\n");
}

TEST(ScenarioFile, KnowsTheDimensionsOfEveryMachine) {
  const Scenario table = scenario_in(R"(
    duration = "1 s"
    [machine]
    kind = "circular"
    gear_numerator = 40
    home_mark_center = "-90 deg"
    backlash = "0.2 deg"
    friction = "80 mNm"
    [[expect]]
    at = "1 s"
    that = "table = 0 deg"
  )");
  const auto& circular = std::get<twin::CircularAxisDimensions>(table.machine);
  EXPECT_EQ(circular.gear_numerator, 40);
  EXPECT_EQ(circular.home_mark_center, -90'000);
  EXPECT_EQ(circular.backlash, 200);
  EXPECT_EQ(circular.friction, 0.08);
  EXPECT_TRUE(
      std::holds_alternative<twin::RotaryAxisDimensions>(scenario_in("duration = '1 s'\nmachine = 'free'").machine));
  const Scenario shaft = scenario_in("duration = '1 s'\n[machine]\nkind = 'free'\ninertia = '68 g cm2'");
  EXPECT_EQ(std::get<twin::RotaryAxisDimensions>(shaft.machine).inertia, 68e-7);
}

TEST(ScenarioFile, TurnsTheModulesMotorUnlessToldOtherwise) {
  EXPECT_EQ(scenario_in("duration = '1 s'").motor, twin::motors().front());
  EXPECT_EQ(scenario_in("duration = '1 s'\n[motor]\nname = 'ideal'").motor, std::nullopt);
  EXPECT_EQ(scenario_in("duration = '1 s'\nmotor = 'ideal'").motor, std::nullopt) << "a name alone";
  const Scenario changed = scenario_in(R"(
    duration = "1 s"
    [motor]
    name = "QSH6018-86-28-310"
    rotor_inertia = "900 g cm2"
    winding_inductance = "7 mH"
  )");
  twin::MotorData expected = *twin::find_motor("QSH6018-86-28-310");
  expected.rotor_inertia = 900e-7;
  expected.winding_inductance = 7e-3;
  EXPECT_EQ(changed.motor, expected);
  EXPECT_EQ(changed.board().motor, expected);
  EXPECT_EQ(changed.mounted(pd1161).motor, expected);
}

TEST(ScenarioFile, TakesTheLoadAsQuantitiesInTheBeginning) {
  const Scenario scenario = scenario_in(R"(
    duration = "1 s"
    [initial]
    temperature = 30
    [load]
    pull = "20 N"
    coulomb_friction = "50 mNm"
  )");
  ASSERT_EQ(scenario.initial.size(), 3u);
  EXPECT_EQ(scenario.initial[0].quantity->name, "load.pull");
  EXPECT_EQ(scenario.initial[0].value, 20);
  EXPECT_EQ(scenario.initial[1].quantity->name, "load.coulomb_friction");
  EXPECT_EQ(scenario.initial[1].value, 0.05);
}

TEST(ScenarioFile, FindsMistakesInMotorsAndLoads) {
  EXPECT_EQ(problems_in("[motor]\nname = \"QSH5718-41-28-05\""),
            "f:3:8: expected QSH5718-41-28-055, QSH5718-51-28-101, QSH5718-56-28-126, QSH5718-76-28-189, "
            "QSH6018-45-28-110, QSH6018-56-28-165, QSH6018-65-28-210, QSH6018-86-28-310 or ideal, found "
            "'QSH5718-41-28-05'; did you mean QSH5718-41-28-055?\n");
  EXPECT_EQ(problems_in("[motor]\nrotor_inertai = \"68 g cm2\""),
            "f:3:1: [motor] has no 'rotor_inertai': did you mean rotor_inertia?\n");
  EXPECT_EQ(problems_in("[motor]\nholding_torque = \"60 Nm\""), "f:3:18: expected 0.005 to 50 Nm, found 60\n");
  EXPECT_EQ(problems_in("[motor]\nname = \"ideal\"\nrotor_inertia = \"68 g cm2\""),
            "f:4:1: an ideal motor has no 'rotor_inertia': its rotor is always where the field is\n");
  EXPECT_EQ(problems_in("[load]\ntorqe = \"1 Nm\""),
            "f:3:1: there is no quantity 'load.torqe': did you mean load.torque?\n");
  EXPECT_EQ(problems_in("[load]\ntorque = \"20 Nm\""), "f:3:10: load.torque goes from -10 to 10 Nm\n");
  EXPECT_EQ(problems_in("[motor]\nname = \"ideal\"\n[load]\ntorque = 1"),
            "f:5:1: load.torque does not exist with an ideal motor\n");
  EXPECT_EQ(problems_in("[machine]\nkind = \"free\"\n[load]\npull = 1"),
            "f:5:1: load.pull does not exist on this machine\n");
  EXPECT_EQ(problems_in("[initial]\nload_measurement = 5"),
            "f:3:1: load_measurement can only be set with an ideal motor\n");
  EXPECT_EQ(problems_in("[initial]\nencoder.a_connected = false"),
            "f:3:9: encoder.a_connected does not exist on this machine\n");
}

TEST(ScenarioFile, KnowsWhichEncoderAModuleHas) {
  EXPECT_EQ(problems_in("[encoder]\nlines = 100"),
            "f:3:9: lines is for the encoder of a TMCM-1110, and the module is a PD-1161\n");
  EXPECT_EQ(problems_in("module = \"tmcm1110\"\n[encoder]\nmagnet_offset = \"3 deg\""),
            "f:4:17: magnet_offset is for the encoder of a PD-1161, and the module is a TMCM-1110\n");
}

TEST(ScenarioFile, KnowsWhatTheModuleCan) {
  EXPECT_EQ(problems_in("[[event]]\nat = \"1 s\"\nsend = \"ROR 0, 500\""), "");
  EXPECT_THAT(problems_in("[[event]]\nat = \"1 s\"\nsend = [\"MST 0\", \"MVP ABC, 0, 1\"]"),
              HasSubstr("f:4:23: 'ABC' is not defined"));
}

TEST(ScenarioFile, CountsColumnsInCharacters) {
  EXPECT_EQ(problems_in("[[event]]\nat = \"1 s\"\nnote = \"µ\"\nset = { temperature = \"5 µm\" }"),
            "f:5:26: 'µm' is not the unit of a temperature: expected a temperature such as 1.5 degC\n");
}

/// Whatever stands in a file, it is read or refused.
RC_GTEST_PROP(ScenarioFile, IsReadOrRefusedWhateverStandsInIt, ()) {
  static const std::vector<std::string> pieces{
      "[[event]]\n",  "[machine]\n", "at = ",       "when = ",      "\"position > 4\"\n",
      "\"1 s\"\n",    "set = ",      "{ a = 1 }\n", "[1, 2]\n",     "kind = ",
      "\"free\"\n",   "5\n",         "true\n",      "duration = ",  "send = ",
      "1979-05-27\n", "[record]\n",  "signals = ",  "[[expect]]\n", "that = "};
  const auto chosen = *rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(pieces));
  std::string text;
  for (const std::string& piece : chosen) text += piece;
  const ScenarioFile file = read_scenario(text);
  RC_ASSERT(file.scenario.has_value() == file.problems.empty());
}

}  // namespace
}  // namespace opentmcl::scenario
