#include <gtest/gtest.h>

#include "firmware/spec/interrupts.hpp"
#include "firmware/spec/io_ports.hpp"
#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

class Parameters : public testing::TestWithParam<ModuleId> {
 protected:
  const ModuleDescription& description() const { return modules[static_cast<std::size_t>(GetParam())]; }
};

INSTANTIATE_TEST_SUITE_P(Both, Parameters, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

/// What SAP, GAP and STAP of every number must answer, from the table alone.
TEST_P(Parameters, EveryAxisParameterFollowsItsRow) {
  Bench bench(description());
  for (int number = 0; number < 256; ++number) {
    SCOPED_TRACE(number);
    const auto type = static_cast<std::uint8_t>(number);
    const AxisParameterSpec* row = nullptr;
    for (const AxisParameterSpec& candidate : axis_parameters) {
      if (static_cast<int>(candidate.number) == number) row = &candidate;
    }
    const ParameterColumn column = row != nullptr ? row->in(GetParam()) : absent;
    EXPECT_EQ(bench.command(Opcode::gap, type).status,
              allows(column.access, Access::r) ? Status::ok : Status::wrong_type);
    EXPECT_EQ(bench.command(Opcode::stap, type).status,
              allows(column.access, Access::e) ? Status::ok : Status::wrong_type);
    const bool writable = allows(column.access, Access::w);
    if (column.minimum > int32_minimum) {
      EXPECT_EQ(bench.command(Opcode::sap, type, 0, column.minimum - 1).status,
                writable ? Status::invalid_value : Status::wrong_type);
    }
    if (column.maximum < int32_maximum) {
      EXPECT_EQ(bench.command(Opcode::sap, type, 0, column.maximum + 1).status,
                writable ? Status::invalid_value : Status::wrong_type);
    }
    if (!writable) continue;
    for (const std::int32_t value : {column.minimum, column.default_value}) {
      EXPECT_EQ(bench.command(Opcode::sap, type, 0, value).status, Status::ok) << value;
    }
    EXPECT_EQ(bench.command(Opcode::sap, type, 1, column.default_value).status, Status::invalid_value) << "motor 1";
    EXPECT_EQ(bench.command(Opcode::gap, type, 1).status, Status::invalid_value) << "motor 1";
  }
}

TEST_P(Parameters, ReadBackWhatWasWritten) {
  Bench bench(description());
  for (const AxisParameterSpec& row : axis_parameters) {
    const ParameterColumn& column = row.in(GetParam());
    if (!allows(column.access, Access::w)) continue;
    if (row.number == AxisParameter::target_position || row.number == AxisParameter::actual_position ||
        row.number == AxisParameter::target_speed || row.number == AxisParameter::reference_search_mode) {
      continue;  // they move the motor, or not all values of the range exist
    }
    for (const std::int32_t value : {column.minimum, column.maximum, column.default_value}) {
      bench.set(row.number, value);
      EXPECT_EQ(bench.get(row.number), value) << row.name;
    }
  }
}

TEST_P(Parameters, StartAtTheirDefaults) {
  Bench bench(description());
  for (const AxisParameterSpec& row : axis_parameters) {
    const ParameterColumn& column = row.in(GetParam());
    const bool is_measured = row.number == AxisParameter::smart_energy_actual_current ||
                             row.number == AxisParameter::driver_error_flags ||
                             row.number == AxisParameter::actual_load_value;
    if (!allows(column.access, Access::r) || is_measured) continue;
    EXPECT_EQ(bench.get(row.number), column.default_value) << row.name;
  }
  for (const GlobalParameterSpec& row : global_parameters) {
    const bool runs = row.number == GlobalParameter::tick_timer || row.number == GlobalParameter::random_number;
    if (!allows(row.in(GetParam()).access, Access::r) || runs) continue;
    EXPECT_EQ(bench.get(row.number), row.in(GetParam()).default_value) << row.name;
  }
}

TEST_P(Parameters, EveryGlobalParameterFollowsItsRow) {
  for (int number = 0; number < 256; ++number) {
    SCOPED_TRACE(number);
    Bench bench(description());
    const auto type = static_cast<std::uint8_t>(number);
    const GlobalParameterSpec* row = nullptr;
    for (const GlobalParameterSpec& candidate : global_parameters) {
      if (static_cast<int>(candidate.number) == number) row = &candidate;
    }
    const ParameterColumn column = row != nullptr ? row->in(GetParam()) : absent;
    EXPECT_EQ(bench.command(Opcode::ggp, type).status,
              allows(column.access, Access::r) ? Status::ok : Status::wrong_type);
    const bool writable = allows(column.access, Access::w);
    if (column.maximum < int32_maximum) {
      EXPECT_EQ(bench.command(Opcode::sgp, type, 0, column.maximum + 1).status,
                writable ? Status::invalid_value : Status::wrong_type);
    }
    EXPECT_EQ(bench.command(Opcode::sgp, type, 0, column.minimum - 1).status,
              writable ? Status::invalid_value : Status::wrong_type);
  }
}

TEST_P(Parameters, BanksThatDoNotExistAreInvalidValues) {
  Bench bench(description());
  for (const int bank : {1, 4, 255}) {
    for (const Opcode opcode : {Opcode::sgp, Opcode::ggp, Opcode::stgp, Opcode::rsgp, Opcode::agp}) {
      EXPECT_EQ(bench.command(opcode, 66, static_cast<std::uint8_t>(bank)).status, Status::invalid_value);
    }
  }
}

TEST_P(Parameters, UserVariablesHoldAnyValueAndTheFirst56CanBeStored) {
  Bench bench(description());
  for (int number = 0; number < 256; ++number) {
    const auto type = static_cast<std::uint8_t>(number);
    EXPECT_EQ(bench.command(Opcode::sgp, type, 2, -number * 1000).status, Status::ok);
    EXPECT_EQ(bench.command(Opcode::ggp, type, 2).value, -number * 1000);
    EXPECT_EQ(bench.command(Opcode::stgp, type, 2).status, number < 56 ? Status::ok : Status::wrong_type);
    EXPECT_EQ(bench.command(Opcode::rsgp, type, 2).status, number < 56 ? Status::ok : Status::wrong_type);
  }
}

TEST_P(Parameters, InterruptSettingsHaveTheNumbersOfTheInterrupts) {
  Bench bench(description());
  for (int number = 0; number < 256; ++number) {
    SCOPED_TRACE(number);
    const auto type = static_cast<std::uint8_t>(number);
    InterruptSetting setting = InterruptSetting::none;
    for (const InterruptSpec& row : interrupts) {
      if (static_cast<int>(row.number) == number && contains(row.modules, GetParam())) setting = row.setting;
    }
    EXPECT_EQ(bench.command(Opcode::sgp, type, 3, 4).status, setting == InterruptSetting::none   ? Status::wrong_type
                                                             : setting == InterruptSetting::edge ? Status::invalid_value
                                                                                                 : Status::ok);
    EXPECT_EQ(bench.command(Opcode::sgp, type, 3, 3).status,
              setting == InterruptSetting::none ? Status::wrong_type : Status::ok);
  }
}

TEST_P(Parameters, EveryPortFollowsItsRow) {
  Bench bench(description());
  for (std::uint8_t bank = 0; bank < 4; ++bank) {
    for (int port = 0; port < 256; ++port) {
      SCOPED_TRACE(testing::Message() << port << ", " << int{bank});
      Access access = Access::none;
      for (const IoPortSpec& row : io_ports) {
        if (static_cast<std::uint8_t>(row.bank) == bank && row.port == port && contains(row.modules, GetParam())) {
          access = row.access;
        }
      }
      const Status missing = bank < 3 ? Status::wrong_type : Status::invalid_value;
      const auto type = static_cast<std::uint8_t>(port);
      EXPECT_EQ(bench.command(Opcode::gio, type, bank).status, allows(access, Access::r) ? Status::ok : missing);
      EXPECT_EQ(bench.command(Opcode::sio, type, bank, 1).status, allows(access, Access::w) ? Status::ok : missing);
      if (allows(access, Access::w)) {
        EXPECT_EQ(bench.command(Opcode::sio, type, bank, 256).status, Status::invalid_value);
      }
    }
  }
}

TEST(Outputs, AreSetOneByOneOrTogetherAndReadBack) {
  Bench bench(pd1161);
  bench.command(Opcode::sio, 1, 2, 1);
  EXPECT_EQ(bench.module.world().outputs() & 3, 2U);
  EXPECT_EQ(bench.command(Opcode::gio, 255, 2).value, 2);
  bench.command(Opcode::sio, 255, 2, 1);
  EXPECT_EQ(bench.command(Opcode::gio, 0, 2).value, 1);
  EXPECT_EQ(bench.command(Opcode::gio, 1, 2).value, 0);
  bench.command(Opcode::calc, 9, 0, 3);
  bench.command(Opcode::sio, 255, 2, -1);
  EXPECT_EQ(bench.command(Opcode::gio, 255, 2).value, 3);
}

TEST(Inputs, ShowTheLevelsOfTheLines) {
  Bench bench(tmcm1110);
  bench.module.world().set_inputs(0b1010110);
  for (int number = 0; number < 7; ++number) {
    EXPECT_EQ(bench.command(Opcode::gio, static_cast<std::uint8_t>(number), 0).value, 0b1010110 >> number & 1);
  }
  EXPECT_EQ(bench.command(Opcode::gio, 255, 0).value, 0b1010110);
}

TEST(AnalogInputs, ShowSupplyAndTemperatureInTheUnitsOfTheManual) {
  Bench bench(pd1161);
  bench.module.world().set_supply_voltage(23'700);
  bench.module.world().set_temperature(41);
  EXPECT_EQ(bench.command(Opcode::gio, 8, 1).value, 237);
  EXPECT_EQ(bench.command(Opcode::gio, 9, 1).value, 41);
}

TEST(TickTimer, CountsMillisecondsFromTheValueItWasSetTo) {
  Bench bench(pd1161);
  bench.set(GlobalParameter::tick_timer, 5000);
  bench.wait(250 * one_millisecond);
  EXPECT_NEAR(bench.get(GlobalParameter::tick_timer), 5250, 4);
}

TEST(RandomNumber, RepeatsItselfAfterTheSameSeedAndIsNeverNegative) {
  Bench bench(pd1161);
  std::vector<std::int32_t> first;
  for (int round = 0; round < 2; ++round) {
    bench.set(GlobalParameter::random_number, 42);
    std::vector<std::int32_t> numbers;
    numbers.reserve(100);
    for (int i = 0; i < 100; ++i) numbers.push_back(bench.get(GlobalParameter::random_number));
    for (const std::int32_t number : numbers) EXPECT_GE(number, 0);
    if (round == 0) first = numbers;
    EXPECT_EQ(numbers, first);
  }
  EXPECT_NE(first[0], first[1]);
}

TEST(EepromLock, RefusesToStoreUntilItIsUnlocked) {
  Bench bench(tmcm1110);
  bench.set(GlobalParameter::eeprom_lock, eeprom_lock_code);
  EXPECT_EQ(bench.get(GlobalParameter::eeprom_lock), 1);
  EXPECT_EQ(bench.command(Opcode::stap, 4).status, Status::eeprom_locked);
  EXPECT_EQ(bench.command(Opcode::stgp, 4, 2).status, Status::eeprom_locked);
  EXPECT_EQ(bench.command(Opcode::sgp, 66, 0, 5).status, Status::eeprom_locked);
  EXPECT_EQ(bench.command(Opcode::sco, 0, 255).status, Status::eeprom_locked);
  bench.set(GlobalParameter::eeprom_lock, eeprom_unlock_code);
  EXPECT_EQ(bench.command(Opcode::stap, 4).status, Status::ok);
}

TEST(ReferenceSearchMode, TakesTheModesOfTheManualAndNoOthers) {
  Bench bench(pd1161);
  for (int value = 0; value <= 210; ++value) {
    const bool exists = (value >= 1 && value <= 8) || (value >= 65 && value <= 68) || (value >= 133 && value <= 136);
    EXPECT_EQ(bench.command(Opcode::sap, 193, 0, value).status, exists ? Status::ok : Status::invalid_value) << value;
  }
}

}  // namespace
}  // namespace opentmcl::tests
