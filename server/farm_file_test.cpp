#include "server/farm_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace opentmcl::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

FarmFile read(std::string_view text) {
  return read_farm(text, "farms/my.toml");
}

std::vector<std::string> problems(std::string_view text) {
  return read(text).problems;
}

TEST(FarmFile, DescribesModulesLinesAndBuses) {
  const FarmFile file = read(R"(
[[module]]
name = "pump"
kind = "tmcm1110"
link = "run/pump"
link_kind = "rs485"
tcp = 6001
wire = 9600
slcan_link = "/tmp/pump-can"
eeprom = "pump.eeprom"
machine = "free"
start = false

[[rs485]]
name = "line"
tcp = 0
baud_rate = 19200

[[can]]
name = "bus"
can_udp = "239.74.163.2:43113"
bit_rate = 250000

[[module]]
name = "axis"
rs485 = "line"
address = 3

[[module]]
name = "arm"
kind = "tmcm1110"
can = "bus"
address = 4
)");
  ASSERT_THAT(file.problems, IsEmpty());
  const FarmDescription& farm = file.description;
  ASSERT_EQ(3u, farm.modules.size());
  const FarmModule& pump = farm.modules[0];
  EXPECT_EQ("pump", pump.name);
  EXPECT_EQ(&tmcm1110, pump.kind);
  EXPECT_EQ("farms/run/pump", pump.doors.link) << "from the file's folder on";
  EXPECT_EQ(hal::PortKind::rs485, pump.link_kind);
  EXPECT_EQ(6001, pump.doors.tcp);
  EXPECT_EQ(9600u, pump.wire);
  EXPECT_EQ("/tmp/pump-can", pump.doors.slcan_link);
  EXPECT_EQ("farms/pump.eeprom", pump.eeprom);
  EXPECT_TRUE(std::holds_alternative<twin::RotaryAxisDimensions>(pump.bench->machine));
  EXPECT_FALSE(pump.starts_program);
  ASSERT_EQ(1u, farm.rs485_lines.size());
  EXPECT_EQ(19'200u, farm.rs485_lines[0].baud_rate);
  ASSERT_EQ(1u, farm.can_buses.size());
  EXPECT_EQ("239.74.163.2", farm.can_buses[0].doors.can_group);
  EXPECT_EQ(43'113, farm.can_buses[0].doors.can_port);
  EXPECT_EQ(250'000u, farm.can_buses[0].bit_rate);
  EXPECT_EQ(0u, farm.modules[1].rs485);
  EXPECT_EQ(&pd1161, farm.modules[1].kind) << "if not given";
  EXPECT_EQ(3, farm.modules[1].address);
  EXPECT_EQ(0u, farm.modules[2].can);
}

TEST(FarmFile, MultipliesModulesThatAreAlike) {
  const FarmFile file = read(R"(
[[rs485]]
name = "line"
link = "line"

[[module]]
name = "axis"
count = 3
rs485 = "line"
address = 10
tcp = 7000
link = "run/{name}.port"
eeprom = "{name}.eeprom"
)");
  ASSERT_THAT(file.problems, IsEmpty());
  ASSERT_EQ(3u, file.description.modules.size());
  const FarmModule& last = file.description.modules[2];
  EXPECT_EQ("axis-3", last.name);
  EXPECT_EQ(12, last.address);
  EXPECT_EQ(7002, last.doors.tcp);
  EXPECT_EQ("farms/run/axis-3.port", last.doors.link);
  EXPECT_EQ("farms/axis-3.eeprom", last.eeprom);
}

TEST(FarmFile, DescribesTheBenchOfAModuleAsAScenarioDoes) {
  const FarmFile file = read(R"(
[[module]]
name = "turntable"
count = 2
tcp = 0
machine = { kind = "circular", gear_numerator = 40 }
motor = { name = "QSH6018-86-28-310", rotor_inertia = "900 g cm2" }
load = { table_torque = "0.5 Nm" }

[[module]]
name = "gantry"
kind = "tmcm1110"
tcp = 0
[module.machine]
pitch = "5 mm"
[module.encoder]
lines = 500
[module.initial]
supply_voltage = "12 V"

[[module]]
name = "usual"
tcp = 0

[[module]]
name = "short"
tcp = 0
machine = "free"
motor = "ideal"
)");
  ASSERT_THAT(file.problems, IsEmpty());
  const std::vector<FarmModule>& modules = file.description.modules;
  ASSERT_EQ(5u, modules.size());
  EXPECT_EQ(modules[0].bench, modules[1].bench) << "modules alike share it";
  const scenario::BenchSetup& turntable = *modules[0].bench;
  EXPECT_EQ(40, std::get<twin::CircularAxisDimensions>(turntable.machine).gear_numerator);
  EXPECT_EQ("QSH6018-86-28-310", turntable.motor->name);
  EXPECT_EQ(900e-7, turntable.motor->rotor_inertia);
  ASSERT_EQ(1u, turntable.initial.size());
  EXPECT_EQ("load.table_torque", turntable.initial[0].quantity->name);
  const scenario::BenchSetup& gantry = *modules[2].bench;
  EXPECT_EQ(5'000, std::get<twin::LinearStageDimensions>(gantry.machine).pitch);
  EXPECT_EQ(500, gantry.encoder.lines);
  EXPECT_EQ(12, gantry.initial.at(0).value);
  const scenario::BenchSetup& usual = *modules[3].bench;
  EXPECT_TRUE(std::holds_alternative<twin::LinearStageDimensions>(usual.machine));
  EXPECT_EQ(twin::motors().front(), usual.motor) << "the module's own, as in tmcl sim";
  EXPECT_TRUE(std::holds_alternative<twin::RotaryAxisDimensions>(modules[4].bench->machine));
  EXPECT_EQ(std::nullopt, modules[4].bench->motor);
}

TEST(FarmFile, ReportsAllMistakesWithTheirPlaceAndTheNearestName) {
  EXPECT_THAT(
      problems(R"([[module]]
name = "pump"
kidn = "pd1161"
tcp = 6000

[[module]]
name = "pump"
kind = "pd1611"
tcp = 70000
link = 5

[[rs485]]
name = "line"
tcp = 6000
baud_rate = 9601

[[module]]
name = "axis one"
rs485 = "lin"
start = "yes"
)"),
      ElementsAre("farms/my.toml:3:1: error: a [[module]] has no key 'kidn': did you mean kind?",
                  "farms/my.toml:4:7: error: 'TCP port 6000' is taken in line 14",
                  "farms/my.toml:7:8: error: 'pump' is taken in line 2",
                  "farms/my.toml:8:8: error: no kind is called 'pd1611': did you mean pd1161?",
                  "farms/my.toml:9:7: error: tcp is 70000: expected a whole number, 0 to 65535",
                  "farms/my.toml:10:8: error: link is no text: expected a path",
                  HasSubstr("farms/my.toml:15:13: error: no module knows 9601 bit/s: expected 9600, 14400"),
                  "farms/my.toml:18:8: error: name is 'axis one': expected a name of letters, digits, -, _ and .",
                  "farms/my.toml:19:9: error: no [[rs485]] is called 'lin': did you mean line?",
                  "farms/my.toml:20:9: error: start is no truth value: expected true or false"));
}

TEST(FarmFile, ReportsWhereItIsNoToml) {
  const std::vector<std::string> found = problems("[[module]]\nname = \"pump\ntcp = 1\n");
  ASSERT_EQ(1u, found.size());
  EXPECT_THAT(found[0], HasSubstr("farms/my.toml:2:"));
}

struct Mistake {
  const char* about;
  const char* text;
  const char* expected;
};

class FarmFileMistake : public testing::TestWithParam<Mistake> {};

TEST_P(FarmFileMistake, IsReported) {
  const std::vector<std::string> found = problems(GetParam().text);
  ASSERT_EQ(1u, found.size()) << testing::PrintToString(found);
  EXPECT_THAT(found[0], HasSubstr(GetParam().expected));
}

constexpr Mistake mistakes[] = {
    {"no_modules", "", ":1:1: error: a farm has modules"},
    {"single_brackets", "[module]\nname = \"a\"\ntcp = 0\n",
     "my.toml:1:2: error: expected [[module]], with two brackets"},
    {"unknown_section", "[[module]]\nname=\"a\"\ntcp=0\n[[modul]]\n",
     ":4:3: error: a farm has no key 'modul': did you mean"},
    {"no_name", "[[module]]\ntcp = 0\n", ":1:1: error: the section lacks a name"},
    {"no_door", "[[module]]\nname = \"a\"\n", ":1:1: error: the module has no door: expected link, tcp"},
    {"line_without_door", "[[rs485]]\nname = \"l\"\n[[module]]\nname=\"a\"\nrs485=\"l\"\n",
     ":1:1: error: the line has no door"},
    {"can_of_pd1161", "[[module]]\nname = \"a\"\nslcan_link = \"x\"\n", ":3:14: error: a PD-1161 has no CAN"},
    {"rs232_of_tmcm1110", "[[module]]\nname=\"a\"\nkind=\"tmcm1110\"\nlink=\"x\"\nlink_kind = \"rs232\"\n",
     ":5:13: error: a TMCM-1110 has no RS232"},
    {"wire_without_port", "[[module]]\nname=\"a\"\nkind=\"tmcm1110\"\nslcan_link=\"x\"\nwire = 9600\n",
     ":5:8: error: wire is for a module with link or tcp"},
    {"shared_link", "[[module]]\nname=\"a\"\ncount = 2\nlink = \"x\"\n", ":4:8: error: many modules cannot share it"},
    {"ports_past_the_end", "[[module]]\nname=\"a\"\ncount = 10\ntcp = 65530\n",
     ":4:7: error: the ports count on past 65535"},
    {"host_address", "[[rs485]]\nname=\"l\"\ntcp=0\n[[module]]\nname=\"a\"\nrs485=\"l\"\naddress = 2\n",
     ":7:11: error: address 2 is the host's"},
    {"counted_to_host_address",
     "[[rs485]]\nname=\"l\"\ntcp=0\n[[module]]\nname=\"a\"\ncount=5\nrs485=\"l\"\naddress = 1\n",
     ":8:11: error: address 2 is the host's"},
    {"same_address",
     "[[rs485]]\nname=\"l\"\ntcp=0\n[[module]]\nname=\"a\"\nrs485=\"l\"\naddress=3\n[[module]]\nname=\"b\"\nrs485="
     "\"l\"\naddress = 3\n",
     ":11:11: error: address 3 on this bus is that of 'a'"},
    {"no_such_program", "[[module]]\nname=\"a\"\ntcp=0\nprogram = \"nowhere.tmc\"\n",
     ":4:11: error: there is no file 'farms/nowhere.tmc'"},
    {"machine", "[[module]]\nname=\"a\"\ntcp=0\nmachine = \"stge\"\n",
     ":4:11: error: expected stage, circular or free, found 'stge'; did you mean stage?"},
    {"key_of_machine", "[[module]]\nname=\"a\"\ntcp=0\n[module.machine]\npitsh = 2\n",
     ":5:1: error: [module.machine] of kind stage has no 'pitsh': did you mean pitch?"},
    {"unit_of_motor", "[[module]]\nname=\"a\"\ntcp=0\nmotor = { holding_torque = \"0.5 N\" }\n",
     ":4:33: error: 'N' is not the unit of a torque"},
    {"load_of_ideal_motor", "[[module]]\nname=\"a\"\ntcp=0\nmotor=\"ideal\"\nload = { torque = 1 }\n",
     ":5:10: error: load.torque does not exist with an ideal motor"},
    {"bench_of_no_module", "[[module]]\nname=\"a\"\ntcp=0\n[machine]\nkind = \"free\"\n",
     ":4:1: error: machine is said of each module: expected [module.machine] behind its [[module]]"},
    {"misspelt_bench", "[[module]]\nname=\"a\"\ntcp=0\nmotr = \"ideal\"\n",
     ":4:1: error: a [[module]] has no key 'motr': did you mean motor?"},
    {"no_group", "[[module]]\nname=\"a\"\nkind=\"tmcm1110\"\ncan_udp = \"239.1.1.1\"\n",
     ":4:11: error: can_udp is '239.1.1.1': expected GROUP:PORT"},
};

INSTANTIATE_TEST_SUITE_P(, FarmFileMistake, testing::ValuesIn(mistakes),
                         [](const auto& tested) { return std::string(tested.param.about); });

TEST(FarmFile, IsDocumentedKeyByKey) {
  std::ifstream file(OPENTMCL_DOCUMENTS "/farm.md");
  std::stringstream document;
  document << file.rdbuf();
  EXPECT_THAT(document.str(), HasSubstr(farm_file_reference()));
}

}  // namespace
}  // namespace opentmcl::server
