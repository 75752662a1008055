// Every kind of write of settings, with the power cut after each single byte of it.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware/param/crc16.hpp"
#include "tests/power_cut/visible_settings.hpp"

namespace opentmcl::tests {
namespace {

constexpr unsigned bank_2 = 2;

struct Write {
  const char* name;
  /// Commands that write; `round` makes their values differ, from 0 on.
  std::vector<Command> (*commands)(ModuleId module, std::int32_t round);
  bool at_once;                     ///< all settings change together or none does
  bool stores_coordinates = false;  ///< coordinate storage (84) is switched on before
};

/// Numbers of the letter E of both manuals, with two values that are no defaults.
struct StoredAxisParameter {
  unsigned number;
  bool pd1161_too;
  std::int32_t values[2];
};
constexpr StoredAxisParameter stored_axis_parameters[] = {
    {4, true, {300, 1999}},     {5, true, {17, 0x7FF}},   {6, true, {100, 255}},     {7, false, {50, 0}},
    {12, true, {0, 1}},         {13, true, {0, 1}},       {130, true, {2, 2047}},    {140, false, {4, 7}},
    {149, true, {1, 0}},        {153, true, {8, 6}},      {154, true, {4, 5}},       {193, false, {3, 136}},
    {194, false, {600, 2047}},  {195, false, {0, 77}},    {204, true, {65535, 256}}, {210, false, {-512, 1 << 30}},
    {212, false, {65535, 255}}, {214, true, {1, 0xFF00}}, {254, true, {1, 0}},
};

std::vector<Command> store_axis_parameters(ModuleId module, std::int32_t round) {
  std::vector<Command> commands;
  for (const StoredAxisParameter& row : stored_axis_parameters) {
    if (module == ModuleId::pd1161 && !row.pd1161_too) continue;
    commands.push_back(command(Opcode::sap, row.number, 0, row.values[round % 2]));
    commands.push_back(command(Opcode::stap, row.number));
  }
  return commands;
}

/// Numbers of the letter A but for the magic (64) and the protection (81), whose writes do more than store.
struct StoredGlobalParameter {
  unsigned number;
  bool tmcm1110;
  bool pd1161;
  std::int32_t values[2];
};
constexpr StoredGlobalParameter stored_global_parameters[] = {
    {65, true, true, {7, 1}},     {66, true, true, {9, 255}},  {67, false, true, {16, 32}},
    {68, true, true, {65535, 3}}, {69, true, false, {2, 7}},   {70, true, false, {0x7FF, 5}},
    {71, true, false, {256, 0}},  {75, true, true, {15, 1}},   {76, true, true, {3, 200}},
    {77, true, true, {1, 0}},     {78, true, false, {63, 21}}, {79, true, true, {1, 0}},
    {82, true, false, {999, 1}},  {83, true, false, {77, 1}},  {84, true, true, {1, 0}},
    {85, true, true, {1, 0}},     {86, true, false, {15, 1}},  {87, true, true, {88, 99}},
    {90, true, true, {1, 0}},
};

std::vector<Command> set_global_parameters(ModuleId module, std::int32_t round) {
  std::vector<Command> commands;
  for (const StoredGlobalParameter& row : stored_global_parameters) {
    if (!(module == ModuleId::pd1161 ? row.pd1161 : row.tmcm1110)) continue;
    commands.push_back(command(Opcode::sgp, row.number, 0, row.values[round % 2]));
  }
  return commands;
}

constexpr std::int32_t telling_value(std::int32_t round, std::int32_t number) {
  return static_cast<std::int32_t>((static_cast<std::uint32_t>(round) + 1) * 0x9E3779B1U +
                                   static_cast<std::uint32_t>(number) * 0x01010101U);
}

std::vector<Command> store_user_variables(ModuleId, std::int32_t round) {
  std::vector<Command> commands;
  for (unsigned number = 0; number < 56; ++number) {
    commands.push_back(command(Opcode::sgp, number, bank_2, telling_value(round, static_cast<std::int32_t>(number))));
    commands.push_back(command(Opcode::stgp, number, bank_2));
  }
  return commands;
}

std::vector<Command> set_all_coordinates(std::int32_t round) {
  std::vector<Command> commands;
  for (unsigned number = 0; number <= 20; ++number) {
    commands.push_back(command(Opcode::sco, number, 0, telling_value(round, static_cast<std::int32_t>(number))));
  }
  return commands;
}

std::vector<Command> copy_all_coordinates(ModuleId, std::int32_t round) {
  std::vector<Command> commands = set_all_coordinates(round);
  commands.push_back(command(Opcode::sco, 0, 255));
  return commands;
}

std::vector<Command> copy_one_coordinate(ModuleId, std::int32_t round) {
  std::vector<Command> commands = set_all_coordinates(round);
  commands.push_back(command(Opcode::sco, 13, 255));
  return commands;
}

std::vector<Command> set_stored_coordinates(ModuleId, std::int32_t round) {
  return set_all_coordinates(round);
}

std::vector<Command> capture_stored_coordinate(ModuleId, std::int32_t round) {
  constexpr std::int32_t velocity_mode = 2;
  return {command(Opcode::sap, 138, 0, velocity_mode), command(Opcode::sap, 1, 0, 5000 + round),
          command(Opcode::cco, 20)};
}

std::vector<Command> restore_factory_settings(ModuleId, std::int32_t) {
  return {command(Opcode::restore_factory_settings, 0, 0, 1234)};
}

constexpr Write writes[] = {
    {"axis_parameters", store_axis_parameters, false},
    {"global_parameters", set_global_parameters, false},
    {"user_variables", store_user_variables, false},
    {"all_coordinates_at_once", copy_all_coordinates, false},
    {"one_coordinate", copy_one_coordinate, true},
    {"coordinates_stored_as_they_are_set", set_stored_coordinates, false, true},
    {"captured_coordinate", capture_stored_coordinate, true, true},
    {"factory_settings", restore_factory_settings, true},
};

/// Sends commands that need not be answered: 137 is not.
void send_all(RecordedModule& module, const std::vector<Command>& commands) {
  for (const Command& each : commands) {
    if (each.opcode == static_cast<std::uint8_t>(Opcode::restore_factory_settings)) {
      EXPECT_FALSE(module.exchange(each).has_value());
    } else {
      module.execute(each);
    }
  }
  module.settle();
}

/// The EEPROM after some commands.
Image image_after(const ModuleDescription& description, const Image& before, const std::vector<Command>& commands) {
  RecordedModule module(description, before);
  send_all(module, commands);
  return module.image();
}

/// An EEPROM in which each setting was written `rounds` times, so that either copy may be the newer one.
Image used_image(const ModuleDescription& description, int rounds) {
  Image image = image_after(description, erased_image(), {});
  for (int round = 0; round < rounds; ++round) {
    for (const auto& commands :
         {store_axis_parameters, set_global_parameters, store_user_variables, copy_all_coordinates}) {
      image = image_after(description, image, commands(description.id, round));
    }
  }
  return image;
}

class PowerCut : public testing::TestWithParam<std::tuple<ModuleId, Write>> {
 protected:
  const ModuleDescription& description() const { return modules[static_cast<std::size_t>(std::get<0>(GetParam()))]; }
  const Write& write() const { return std::get<1>(GetParam()); }
};

std::string module_name(ModuleId module) {
  return module == ModuleId::pd1161 ? "pd1161" : "tmcm1110";
}

INSTANTIATE_TEST_SUITE_P(Settings, PowerCut,
                         testing::Combine(testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                                          testing::ValuesIn(writes)),
                         [](const auto& tested) {
                           return module_name(std::get<0>(tested.param)) + "_" + std::get<1>(tested.param).name;
                         });

TEST_P(PowerCut, LeavesEachSettingAtItsOldOrItsNewValue) {
  for (int rounds = 0; rounds <= 2; ++rounds) {
    const Image before = image_after(description(), used_image(description(), rounds),
                                     {command(Opcode::sgp, 84, 0, write().stores_coordinates ? 1 : 0)});
    RecordedModule module(description(), before);
    send_all(module, write().commands(description().id, rounds));
    ASSERT_FALSE(module.writes().empty()) << "this operation writes something";

    const auto old_settings = visible_settings(description(), before);
    const auto new_settings = visible_settings(description(), module.image());
    const std::size_t cuts = at_every_cut(before, module.writes(), [&](const Image& left) {
      if (HasFailure()) return;
      const auto settings = visible_settings(description(), left);
      if (write().at_once) {
        EXPECT_TRUE(settings == old_settings || settings == new_settings) << "all or nothing";
      }
      EXPECT_TRUE(are_old_or_new(settings, old_settings, new_settings)) << "written before: " << rounds << " times";
    });
    EXPECT_GE(cuts, 8U) << "a record has eight bytes";
  }
}

TEST_P(PowerCut, LeavesOldOrNewValuesWhenItComesAgainDuringTheSecondAttempt) {
  // Each record is written without regard to the others: of many, a few are enough.
  constexpr std::size_t many = 25;
  std::vector<Command> commands = write().commands(description().id, 2);
  if (commands.size() > many) commands.resize(4);
  const Image before = image_after(description(), used_image(description(), 2),
                                   {command(Opcode::sgp, 84, 0, write().stores_coordinates ? 1 : 0)});
  RecordedModule first(description(), before);
  send_all(first, commands);
  ASSERT_FALSE(first.writes().empty());
  const auto old_settings = visible_settings(description(), before);
  const auto new_settings = visible_settings(description(), first.image());
  at_every_cut(before, first.writes(), [&](const Image& interrupted) {
    RecordedModule second(description(), interrupted);
    send_all(second, commands);
    at_every_cut(interrupted, second.writes(), [&](const Image& left) {
      if (!HasFailure()) are_old_or_new(visible_settings(description(), left), old_settings, new_settings);
    });
    EXPECT_EQ(visible_settings(description(), second.image()), new_settings);
  });
}

/// A checksum of 16 bits cannot tell all torn records from whole ones: values that differ in the right bits leave it
/// right. These are the differences for records that begin or end with their sequence number.
TEST(TornRecord, IsNotTakenForANewerOneWhenItsChecksumIsRightByChance) {
  constexpr std::uint32_t polynomial = 0x11021;
  constexpr std::uint8_t sequences_and_slot[] = {1 ^ 3, 0};  // the third record overwrites the first
  const std::uint32_t behind_the_sequence =
      static_cast<std::uint32_t>(crc16(sequences_and_slot, sizeof sequences_and_slot, 0)) << 16;
  constexpr std::uint32_t first = 0x12345678;
  constexpr std::uint32_t second = 1000;
  constexpr std::uint32_t beyond_the_cut = 0x5A;
  const auto store = [](std::uint32_t value) {
    return std::vector<Command>{command(Opcode::sgp, 7, bank_2, static_cast<std::int32_t>(value)),
                                command(Opcode::stgp, 7, bank_2)};
  };
  for (const std::uint32_t difference : {behind_the_sequence, polynomial << 8, polynomial << 15}) {
    const Image before = image_after(pd1161, image_after(pd1161, erased_image(), store(first)), store(second));
    const std::uint32_t third = first ^ difference ^ beyond_the_cut;
    RecordedModule module(pd1161, before);
    send_all(module, store(third));
    at_every_cut(before, module.writes(), [&](const Image& left) {
      RecordedModule restarted(pd1161, left);
      const auto found = static_cast<std::uint32_t>(restarted.execute(command(Opcode::ggp, 7, bank_2)));
      EXPECT_TRUE(found == second || found == third)
          << std::hex << found << " instead of " << second << " or " << third;
    });
  }
}

TEST(FactorySettings, DoNotBringOldSettingsBackHoweverOftenTheyAreRestored) {
  Image image = used_image(tmcm1110, 1);
  const auto factory_settings = visible_settings(tmcm1110, erased_image());
  for (int reset = 0; reset < 300; ++reset) {
    image = image_after(tmcm1110, image, restore_factory_settings(ModuleId::tmcm1110, 0));
    ASSERT_EQ(visible_settings(tmcm1110, image), factory_settings) << "after " << reset + 1 << " factory resets";
  }
}

class EepromOfAnotherModule : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(FactoryResets, EepromOfAnotherModule, testing::Values(0, 1, 2, 3));

TEST_P(EepromOfAnotherModule, IsPutIntoServiceWithoutAnyOfItsSettings) {
  // Each factory reset writes the other copy of the header.
  Image foreign = used_image(pd1161, 1);
  for (int reset = 0; reset < GetParam(); ++reset) {
    foreign = image_after(pd1161, foreign, restore_factory_settings(ModuleId::pd1161, 0));
    foreign = image_after(pd1161, foreign, store_user_variables(ModuleId::pd1161, reset));
    foreign = image_after(pd1161, foreign, {command(Opcode::sgp, 84, 0, 1)});
  }
  const auto factory_settings = visible_settings(tmcm1110, erased_image());
  RecordedModule module(tmcm1110, foreign);
  module.settle();
  at_every_cut(foreign, module.writes(), [&](const Image& left) {
    if (!HasFailure()) {
      EXPECT_EQ(visible_settings(tmcm1110, left), factory_settings);
    }
  });
}

}  // namespace
}  // namespace opentmcl::tests
