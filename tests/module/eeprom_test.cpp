#include <gtest/gtest.h>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr Microseconds time_to_write = 3'000 * one_millisecond;

class Eeprom : public testing::TestWithParam<ModuleId> {
 protected:
  const ModuleDescription& description() const { return modules[static_cast<std::size_t>(GetParam())]; }
};

INSTANTIATE_TEST_SUITE_P(Both, Eeprom, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

std::int32_t other_than_default(const ParameterColumn& column) {
  return column.default_value == column.maximum ? column.minimum : column.maximum;
}

TEST_P(Eeprom, KeepsStoredAxisParametersAndLosesTheOthers) {
  Bench bench(description());
  for (const AxisParameterSpec& row : axis_parameters) {
    const ParameterColumn& column = row.in(GetParam());
    if (!allows(column.access, Access::w) || row.number <= AxisParameter::target_speed) continue;
    const bool gaps = row.number == AxisParameter::reference_search_mode;
    bench.set(row.number, gaps ? 4 : other_than_default(column));
    if (allows(column.access, Access::e)) {
      EXPECT_EQ(bench.command(Opcode::stap, static_cast<std::uint8_t>(row.number)).status, Status::ok);
    }
  }
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(one_millisecond);
  for (const AxisParameterSpec& row : axis_parameters) {
    const ParameterColumn& column = row.in(GetParam());
    if (!allows(column.access, Access::w) || row.number <= AxisParameter::target_speed) continue;
    const bool gaps = row.number == AxisParameter::reference_search_mode;
    const std::int32_t changed = gaps ? 4 : other_than_default(column);
    EXPECT_EQ(bench.get(row.number), allows(column.access, Access::e) ? changed : column.default_value) << row.name;
  }
}

TEST_P(Eeprom, KeepsGlobalParametersWithTheLetterAWithoutBeingTold) {
  Bench bench(description());
  const auto is_special = [](GlobalParameter number) {
    // Lock and magic change what a restart does; addresses and the ASCII mode change how it is spoken to.
    return number == GlobalParameter::eeprom_lock || number == GlobalParameter::eeprom_magic ||
           number == GlobalParameter::serial_address || number == GlobalParameter::serial_host_address ||
           number == GlobalParameter::ascii_mode;
  };
  for (const GlobalParameterSpec& row : global_parameters) {
    const ParameterColumn& column = row.in(GetParam());
    if (!allows(column.access, Access::a) || is_special(row.number)) continue;
    bench.set(row.number, other_than_default(column));
  }
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(one_millisecond);
  for (const GlobalParameterSpec& row : global_parameters) {
    const ParameterColumn& column = row.in(GetParam());
    if (!allows(column.access, Access::a) || is_special(row.number)) continue;
    EXPECT_EQ(bench.get(row.number), other_than_default(column)) << row.name;
  }
  EXPECT_EQ(bench.get(GlobalParameter::suppress_reply), 0);
}

TEST_P(Eeprom, KeepsUserVariablesThatWereStoredUnlessParameter85ForbidsIt) {
  Bench bench(description());
  for (std::uint8_t number = 0; number < 100; ++number) bench.command(Opcode::sgp, number, 2, 7000 + number);
  for (std::uint8_t number = 0; number < 56; number = static_cast<std::uint8_t>(number + 2)) {
    bench.command(Opcode::stgp, number, 2);
  }
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(one_millisecond);
  for (std::uint8_t number = 0; number < 100; ++number) {
    const bool stored = number < 56 && number % 2 == 0;
    EXPECT_EQ(bench.command(Opcode::ggp, number, 2).value, stored ? 7000 + number : 0) << int{number};
  }
  bench.set(GlobalParameter::do_not_restore_user_variables, 1);
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(one_millisecond);
  EXPECT_EQ(bench.command(Opcode::ggp, 0, 2).value, 0);
  bench.command(Opcode::rsgp, 0, 2);
  EXPECT_EQ(bench.command(Opcode::ggp, 0, 2).value, 7000) << "RSGP still gets it";
}

TEST_P(Eeprom, KeepsCoordinatesOnlyWhenToldTo) {
  Bench bench(description());
  bench.command(Opcode::sco, 1, 0, 111);
  bench.command(Opcode::sco, 2, 0, 222);
  bench.command(Opcode::sco, 2, 255, 0);
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(one_millisecond);
  EXPECT_EQ(bench.command(Opcode::gco, 2, 0).value, 0) << "copied to the EEPROM, but not restored by itself";
  bench.command(Opcode::gco, 0, 255);
  EXPECT_EQ(bench.command(Opcode::gco, 2, 0).value, 222);
  EXPECT_EQ(bench.command(Opcode::gco, 1, 0).value, 0);
  bench.set(GlobalParameter::coordinate_storage, 1);
  bench.command(Opcode::sco, 20, 0, -20);
  bench.command(Opcode::sco, 0, 0, 5);
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(one_millisecond);
  EXPECT_EQ(bench.command(Opcode::gco, 20, 0).value, -20);
  EXPECT_EQ(bench.command(Opcode::gco, 0, 0).value, 0) << "coordinate 0 lives in RAM only";
}

TEST_P(Eeprom, RestoresAParameterToItsStoredValueOrItsDefault) {
  Bench bench(description());
  const auto type = static_cast<std::uint8_t>(AxisParameter::maximum_positioning_speed);
  bench.set(AxisParameter::maximum_positioning_speed, 300);
  bench.command(Opcode::rsap, type);
  EXPECT_EQ(bench.get(AxisParameter::maximum_positioning_speed), 1000);
  bench.set(AxisParameter::maximum_positioning_speed, 300);
  bench.command(Opcode::stap, type);
  bench.set(AxisParameter::maximum_positioning_speed, 400);
  bench.command(Opcode::rsap, type);
  EXPECT_EQ(bench.get(AxisParameter::maximum_positioning_speed), 300);
}

TEST_P(Eeprom, KeepsTheProgramAndStartsItWhenAutoStartIsOn) {
  Bench bench(description());
  bench.download("SGP 1, 2, 77\nLoop: JA Loop\n");
  bench.set(GlobalParameter::auto_start, 1);
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(5 * one_millisecond);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 1);
  EXPECT_EQ(bench.command(Opcode::ggp, 1, 2).value, 77);
}

TEST_P(Eeprom, NeverStartsAProgramWhoseDownloadDidNotEnd) {
  Bench bench(description());
  bench.download("Loop: JA Loop\n");
  bench.set(GlobalParameter::auto_start, 1);
  bench.command(Opcode::enter_download_mode);
  bench.command(Opcode::sgp, 1, 2, 1);
  bench.wait(time_to_write);
  bench.module.power_cycle();
  bench.wait(5 * one_millisecond);
  EXPECT_EQ(bench.get(GlobalParameter::application_status), 0);
}

TEST_P(Eeprom, ForgetsEverythingByCommand137WithoutAReply) {
  Bench bench(description());
  bench.set(AxisParameter::maximum_positioning_speed, 300);
  bench.command(Opcode::stap, 4);
  bench.wait(time_to_write);
  EXPECT_EQ(bench.command(Opcode::restore_factory_settings, 0, 0, 1).status, Status::invalid_value);
  const Datagram request =
      encode(Request{1, {static_cast<std::uint8_t>(Opcode::restore_factory_settings), 0, 0, confirmation_code}});
  EXPECT_FALSE(bench.exchange(request).has_value());
  bench.wait(time_to_write);
  EXPECT_EQ(bench.get(AxisParameter::maximum_positioning_speed), 1000);
}

TEST_P(Eeprom, LeavesTheOldOrTheNewValueWhereverThePowerIsCut) {
  // A record is 8 bytes; with the writes before it this covers every byte of two values.
  for (std::size_t cut = 0; cut <= 40; ++cut) {
    Bench bench(description());
    bench.set(AxisParameter::maximum_positioning_speed, 111);
    bench.command(Opcode::stap, 4);
    bench.wait(time_to_write);
    bench.module.world().eeprom().cut_power_after(cut);
    bench.set(AxisParameter::maximum_positioning_speed, 222);
    bench.command(Opcode::stap, 4);
    bench.wait(50 * one_millisecond);
    bench.set(AxisParameter::maximum_positioning_speed, 333);
    bench.command(Opcode::stap, 4);
    bench.wait(time_to_write);
    bench.module.power_cycle();
    bench.wait(one_millisecond);
    const std::int32_t expected = cut < 8 ? 111 : cut < 16 ? 222 : 333;
    EXPECT_EQ(bench.get(AxisParameter::maximum_positioning_speed), expected) << "cut after " << cut << " bytes";
  }
}

TEST(EepromOfAnotherModule, IsPutIntoServiceWithFactorySettings) {
  Bench first(pd1161);
  first.set(AxisParameter::maximum_positioning_speed, 300);
  first.command(Opcode::stap, 4);
  first.wait(time_to_write);
  Bench second(tmcm1110);
  second.module.world().eeprom().load(first.module.world().eeprom().image());
  second.module.power_cycle();
  second.wait(time_to_write);
  EXPECT_EQ(second.get(AxisParameter::maximum_positioning_speed), 1000);
}

TEST(CodeProtection, HidesTheProgramAndErasesItWhenItIsTakenAway) {
  Bench bench(pd1161);
  bench.download("MVP ABS, 0, 1234\n");
  const auto first_instruction = [&bench] {
    return *bench.exchange(encode(Request{1, {static_cast<std::uint8_t>(Opcode::read_program_memory), 0, 0, 0}}));
  };
  EXPECT_EQ(first_instruction(), (Datagram{{2, 4, 0, 0, 0, 0, 4, 0xD2, 0xDC}}));
  bench.set(GlobalParameter::code_protection, 3);
  EXPECT_EQ(first_instruction(), (Datagram{{2, 0, 0, 0, 0, 0, 0, 0, 2}}));
  EXPECT_EQ(bench.command(Opcode::enter_download_mode).status, Status::eeprom_write_protected);
  bench.set(GlobalParameter::code_protection, 0);
  bench.wait(time_to_write);
  EXPECT_EQ(first_instruction(), (Datagram{{2, 0, 0, 0, 0, 0, 0, 0, 2}}));
}

}  // namespace
}  // namespace opentmcl::tests
