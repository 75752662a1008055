// Downloads, erasure and what the code protection promises, with the power cut after each single byte written.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/power_cut/visible_settings.hpp"

namespace opentmcl::tests {
namespace {

using Instruction = std::array<std::uint8_t, 7>;
using Program = std::vector<Instruction>;

constexpr unsigned capacity = 2048;
constexpr unsigned auto_start = 77;
constexpr unsigned code_protection = 81;

constexpr Command start_download(std::int32_t address) {
  return command(Opcode::enter_download_mode, 0, 0, address);
}

/// A program that runs for ever in its first instruction; what follows tells one program from another.
std::vector<Command> program(unsigned length, std::uint32_t seed) {
  std::vector<Command> instructions = {command(Opcode::ja)};
  for (unsigned address = 1; address < length; ++address) {
    const std::uint32_t value = (address + 1) * 0x9E3779B1U ^ seed;
    instructions.push_back(command(Opcode::sgp, value >> 8 & 0xFF, 2, static_cast<std::int32_t>(value)));
  }
  return instructions;
}

/// Instructions framed by the commands that begin and end a download.
std::vector<Command> download(std::int32_t address, std::vector<Command> instructions) {
  instructions.insert(instructions.begin(), start_download(address));
  instructions.push_back(command(Opcode::exit_download_mode));
  return instructions;
}

void send_all(RecordedModule& module, const std::vector<Command>& commands) {
  for (const Command& each : commands) module.execute(each);
  module.settle();
}

Image image_after(const ModuleDescription& description, const Image& before, const std::vector<Command>& commands) {
  RecordedModule module(description, before);
  send_all(module, commands);
  return module.image();
}

Program program_in(const ModuleDescription& description, const Image& image) {
  RecordedModule module(description, image);
  return visible_program(module, capacity);
}

bool is_blank(const Program& program) {
  return !program.empty() &&
         std::all_of(program.begin(), program.end(), [](const Instruction& each) { return each == Instruction{}; });
}

/// A module with auto start and a whole program.
Image image_with_program(const ModuleDescription& description) {
  std::vector<Command> commands = download(0, program(300, 0x1234567));
  commands.push_back(command(Opcode::sgp, auto_start, 0, 1));
  return image_after(description, erased_image(), commands);
}

class ProgramPowerCut : public testing::TestWithParam<ModuleId> {
 protected:
  const ModuleDescription& description() const { return modules[static_cast<std::size_t>(GetParam())]; }

  /// At every cut point of a download the settings stay as they were, and a program that starts by itself is all old or
  /// all new.
  void expect_whole_or_unusable(const Image& before, const std::vector<Command>& commands) {
    RecordedModule module(description(), before);
    send_all(module, commands);
    const auto settings = visible_settings(description(), before);
    const Program old_program = program_in(description(), before);
    const Program new_program = program_in(description(), module.image());
    bool old_was_seen = false;
    bool new_was_seen = false;
    at_every_cut(before, module.writes(), [&](const Image& left) {
      if (HasFailure()) return;
      RecordedModule restarted(description(), left);
      EXPECT_EQ(visible_settings(restarted), settings);
      if (!is_program_running(restarted)) return;
      const Program found = visible_program(restarted, capacity);
      EXPECT_TRUE(found == old_program || found == new_program) << "a program that is not whole was started";
      old_was_seen = old_was_seen || found == old_program;
      new_was_seen = new_was_seen || found == new_program;
    });
    EXPECT_TRUE(old_was_seen) << "before the download";
    EXPECT_TRUE(new_was_seen) << "after the download";
  }
};

INSTANTIATE_TEST_SUITE_P(Both, ProgramPowerCut, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(ProgramPowerCut, LeavesADownloadOfTheWholeMemoryCompleteOrUnusable) {
  expect_whole_or_unusable(image_with_program(description()), download(0, program(capacity, 0x89ABCDE)));
}

TEST_P(ProgramPowerCut, LeavesADownloadIntoTheMiddleOfAProgramCompleteOrUnusable) {
  std::vector<Command> patch = program(40, 0x55555);
  patch.erase(patch.begin());
  expect_whole_or_unusable(image_with_program(description()), download(100, patch));
}

TEST_P(ProgramPowerCut, LeavesADownloadInTwoPartsCompleteOrUnusable) {
  std::vector<Command> commands = download(250, program(30, 1));
  const std::vector<Command> second = {start_download(5), command(Opcode::sgp, 1, 2, 3), start_download(7),
                                       command(Opcode::sgp, 2, 2, 4), command(Opcode::exit_download_mode)};
  // The first part ends without command 133.
  commands.pop_back();
  commands.insert(commands.end(), second.begin(), second.end());
  expect_whole_or_unusable(image_with_program(description()), commands);
}

TEST_P(ProgramPowerCut, LeavesADownloadThatFollowsAnInterruptedOneCompleteOrUnusable) {
  const Image before = image_with_program(description());
  const std::vector<Command> commands = download(0, program(12, 0x777));
  const auto settings = visible_settings(description(), before);
  const Program old_program = program_in(description(), before);
  const Program new_program = program_in(description(), image_after(description(), before, commands));
  RecordedModule first(description(), before);
  send_all(first, commands);
  at_every_cut(before, first.writes(), [&](const Image& interrupted) {
    RecordedModule second(description(), interrupted);
    send_all(second, commands);
    at_every_cut(interrupted, second.writes(), [&](const Image& left) {
      if (HasFailure()) return;
      RecordedModule restarted(description(), left);
      EXPECT_EQ(visible_settings(restarted), settings);
      if (!is_program_running(restarted)) return;
      const Program found = visible_program(restarted, capacity);
      EXPECT_TRUE(found == old_program || found == new_program);
    });
    EXPECT_EQ(program_in(description(), second.image()), new_program);
  });
}

/// A program and the protection it had, and how somebody tries to get at it.
class Protection : public testing::TestWithParam<std::tuple<ModuleId, std::int32_t>> {
 protected:
  const ModuleDescription& description() const { return modules[static_cast<std::size_t>(std::get<0>(GetParam()))]; }
  std::int32_t protection() const { return std::get<1>(GetParam()); }

  Image protected_image() const {
    return image_after(description(), image_with_program(description()),
                       {command(Opcode::sgp, code_protection, 0, protection())});
  }

  /// Nothing of the old program can be read or started once the protection is off. @return whether it is off
  bool expect_no_leak(RecordedModule& module) {
    const bool reads_are_open = (module.execute(command(Opcode::ggp, code_protection)) & 1) == 0;
    if (reads_are_open) {
      EXPECT_FALSE(is_program_running(module));
      EXPECT_TRUE(is_blank(visible_program(module, capacity))) << "a part of the protected program is readable";
    }
    return reads_are_open;
  }
};

INSTANTIATE_TEST_SUITE_P(Both, Protection,
                         testing::Combine(testing::Values(ModuleId::tmcm1110, ModuleId::pd1161), testing::Values(1, 3)),
                         [](const auto& tested) {
                           return std::string(std::get<0>(tested.param) == ModuleId::pd1161 ? "pd1161" : "tmcm1110") +
                                  "_from_" + std::to_string(std::get<1>(tested.param));
                         });

TEST_P(Protection, IsNotLostBeforeTheProgramIsErased) {
  const Image before = protected_image();
  for (const std::int32_t open : {0, 2}) {
    RecordedModule module(description(), before);
    send_all(module, {command(Opcode::sgp, code_protection, 0, open)});
    const auto old_settings = visible_settings(description(), before);
    const auto new_settings = visible_settings(description(), module.image());
    bool was_open = false;
    at_every_cut(before, module.writes(), [&](const Image& left) {
      if (HasFailure()) return;
      RecordedModule restarted(description(), left);
      EXPECT_TRUE(are_old_or_new(visible_settings(restarted), old_settings, new_settings));
      was_open = expect_no_leak(restarted);
    });
    EXPECT_TRUE(was_open) << "in the end";
  }
}

TEST_P(Protection, IsTakenAwayBySendingTheCommandAgainAfterAPowerCut) {
  const Image before = protected_image();
  const Command open = command(Opcode::sgp, code_protection);
  RecordedModule module(description(), before);
  send_all(module, {open});
  std::size_t cut = 0;
  at_every_cut(before, module.writes(), [&](const Image& interrupted) {
    constexpr std::size_t stride = 997;  // a prime: all offsets in a page come up
    if (HasFailure() || cut++ % stride != 0) return;
    RecordedModule again(description(), interrupted);
    send_all(again, {open});
    EXPECT_TRUE(expect_no_leak(again));
  });
}

TEST_P(Protection, OutlivesARestartWhileTheProgramIsBeingErased) {
  RecordedModule module(description(), protected_image());
  module.execute(command(Opcode::sgp, code_protection));
  module.execute(command(Opcode::software_reset, 0, 0, 1234));
  module.settle();
  EXPECT_TRUE(expect_no_leak(module)) << "the restart waits until the program is erased";
}

TEST_P(Protection, IsNotLostByAFactoryResetBeforeTheProgramIsErased) {
  const Image before = protected_image();
  RecordedModule module(description(), before);
  EXPECT_FALSE(module.exchange(command(Opcode::restore_factory_settings, 0, 0, 1234)).has_value());
  module.settle();
  const auto old_settings = visible_settings(description(), before);
  const auto new_settings = visible_settings(description(), erased_image());
  EXPECT_EQ(visible_settings(description(), module.image()), new_settings);
  bool was_open = false;
  at_every_cut(before, module.writes(), [&](const Image& left) {
    if (HasFailure()) return;
    RecordedModule restarted(description(), left);
    const auto settings = visible_settings(restarted);
    EXPECT_TRUE(settings == old_settings || settings == new_settings) << "all or nothing";
    was_open = expect_no_leak(restarted);
  });
  EXPECT_TRUE(was_open) << "in the end";
}

/// Global parameter 64, which only the TMCM-1110 has, asks the next start for factory settings.
class Magic : public Protection {};

INSTANTIATE_TEST_SUITE_P(Tmcm1110, Magic,
                         testing::Combine(testing::Values(ModuleId::tmcm1110), testing::Values(0, 1, 2, 3)),
                         [](const auto& tested) { return "from_" + std::to_string(std::get<1>(tested.param)); });

TEST_P(Magic, GivesAllFactorySettingsOrNoneAndNoProtectedProgram) {
  constexpr unsigned magic = 64;
  const bool was_protected = (protection() & 1) != 0;
  const Image before = image_after(description(), protected_image(), {command(Opcode::sgp, magic, 0, 0)});
  const auto factory_settings = visible_settings(description(), erased_image());
  RecordedModule module(description(), before);
  module.settle();
  EXPECT_EQ(visible_settings(description(), module.image()), factory_settings);
  std::size_t cut = 0;
  at_every_cut(before, module.writes(), [&](const Image& left) {
    if (HasFailure()) return;
    RecordedModule restarted(description(), left);
    if (was_protected) expect_no_leak(restarted);
    // To erase the whole memory again from each cut point would take minutes.
    constexpr std::size_t stride = 97;
    if (was_protected && cut++ % stride != 0) return;
    restarted.settle();
    EXPECT_EQ(visible_settings(restarted), factory_settings);
    if (was_protected) {
      EXPECT_TRUE(expect_no_leak(restarted));
    }
  });
}

}  // namespace
}  // namespace opentmcl::tests
