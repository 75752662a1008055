// What goes on while pages are written: 5 ms each, one after the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/module/bench.hpp"

namespace opentmcl::tests {
namespace {

constexpr unsigned variables = 56;
constexpr unsigned bank_2 = 2;
constexpr Microseconds page_write = 5 * one_millisecond;

class WhileTheEepromIsBusy : public testing::TestWithParam<ModuleId> {
 protected:
  WhileTheEepromIsBusy() : bench(modules[static_cast<std::size_t>(GetParam())]) {}

  /// Keeps the EEPROM busy for more than a quarter of a second.
  void store_all_variables() {
    ++round_;
    for (std::uint8_t number = 1; number < variables; ++number) {
      bytes_in_the_same_turn({static_cast<std::uint8_t>(Opcode::sgp), number, bank_2, round_});
      bytes_in_the_same_turn({static_cast<std::uint8_t>(Opcode::stgp), number, bank_2, 0});
    }
    ASSERT_TRUE(bench.module.world().eeprom_busy());
  }

  /// Sends a command and looks at the answer at once. @return how many bytes came in the same turn
  std::size_t bytes_in_the_same_turn(const Command& command) {
    const Datagram request = encode(Request{1, command});
    bench.port.received.clear();
    bench.port.to_module.assign(request.bytes, request.bytes + datagram_size);
    bench.module.wake();
    bench.module.advance_to(bench.module.now());
    return bench.port.received.size();
  }

  Bench bench;

 private:
  std::int32_t round_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Both, WhileTheEepromIsBusy, testing::Values(ModuleId::tmcm1110, ModuleId::pd1161),
                         [](const auto& tested) { return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110"; });

TEST_P(WhileTheEepromIsBusy, CommandsAreAnsweredInTheTurnTheyArriveIn) {
  store_all_variables();
  const Command commands[] = {
      {static_cast<std::uint8_t>(Opcode::gap), 1, 0, 0},    {static_cast<std::uint8_t>(Opcode::sap), 4, 0, 500},
      {static_cast<std::uint8_t>(Opcode::stap), 4, 0, 0},   {static_cast<std::uint8_t>(Opcode::rsap), 4, 0, 0},
      {static_cast<std::uint8_t>(Opcode::sgp), 87, 0, 7},   {static_cast<std::uint8_t>(Opcode::ggp), 87, 0, 0},
      {static_cast<std::uint8_t>(Opcode::stgp), 0, 2, 0},   {static_cast<std::uint8_t>(Opcode::rsgp), 0, 2, 0},
      {static_cast<std::uint8_t>(Opcode::sco), 0, 255, 0},  {static_cast<std::uint8_t>(Opcode::gco), 0, 255, 0},
      {static_cast<std::uint8_t>(Opcode::ror), 0, 0, 100},  {static_cast<std::uint8_t>(Opcode::mst), 0, 0, 0},
      {static_cast<std::uint8_t>(Opcode::mvp), 0, 0, 1000}, {static_cast<std::uint8_t>(Opcode::gio), 0, 0, 0},
  };
  for (const Command& each : commands) {
    ASSERT_TRUE(bench.module.world().eeprom_busy());
    EXPECT_EQ(bytes_in_the_same_turn(each), datagram_size) << "opcode " << int{each.opcode};
    bench.wait(one_millisecond);
  }
}

TEST_P(WhileTheEepromIsBusy, TheMotorKeepsItsSpeed) {
  bench.command(Opcode::ror, 0, 0, 300);
  bench.wait(500 * one_millisecond);
  const auto distance_in = [this](Microseconds duration) {
    const std::int32_t from = bench.get(AxisParameter::actual_position);
    bench.wait(duration);
    return bench.get(AxisParameter::actual_position) - from;
  };
  constexpr Microseconds duration = 50 * one_millisecond;
  const std::int32_t undisturbed = distance_in(duration);
  store_all_variables();
  EXPECT_NEAR(distance_in(duration), undisturbed, 1);
  EXPECT_TRUE(bench.module.world().eeprom_busy());
  EXPECT_EQ(bench.get(AxisParameter::actual_speed), 300);
}

TEST_P(WhileTheEepromIsBusy, ALoopOfTheProgramKeepsItsPace) {
  bench.run_program("Loop: CALC ADD, 1\nAGP 0, 2\nJA Loop\n");
  bench.wait(100 * one_millisecond);
  const auto rounds_in = [this](Microseconds duration) {
    const std::int32_t before = bench.command(Opcode::ggp, 0, bank_2).value;
    bench.wait(duration);
    return bench.command(Opcode::ggp, 0, bank_2).value - before;
  };
  constexpr Microseconds duration = 200 * one_millisecond;
  const std::int32_t undisturbed = rounds_in(duration);
  store_all_variables();
  EXPECT_NEAR(rounds_in(duration), undisturbed, 1);
  EXPECT_TRUE(bench.module.world().eeprom_busy());
}

TEST_P(WhileTheEepromIsBusy, AProgramComesToInstructionsItHasNotHadYet) {
  // More instructions than any cache holds, so that they have to be fetched between two page writes.
  constexpr std::int32_t length = 1500;
  std::string source;
  for (int i = 0; i < length; ++i) source += "CALC ADD, 1\n";
  bench.download(source + "STOP\n");
  store_all_variables();
  bench.command(Opcode::run_application, 1, 0, 0);
  const auto program_counter = [this] { return bench.get(GlobalParameter::program_counter); };
  for (int i = 0; i < 5; ++i) {
    const std::int32_t before = program_counter();
    bench.wait(4 * page_write);
    ASSERT_TRUE(bench.module.world().eeprom_busy());
    EXPECT_GT(program_counter(), before);
  }
  bench.wait(1'000 * one_millisecond);
  EXPECT_EQ(program_counter(), length) << "on the STOP at the end";
}

TEST_P(WhileTheEepromIsBusy, TheOtherPortIsServedWhileADownloadWaits) {
  TestPort downloading;
  TestPort asking;
  VirtualModule module(modules[static_cast<std::size_t>(GetParam())],
                       {{&downloading, hal::PortKind::usb}, {&asking, hal::PortKind::rs485}});
  module.advance_to(one_millisecond);
  const auto put = [](TestPort& port, const Command& command) {
    const Datagram request = encode(Request{1, command});
    port.to_module.insert(port.to_module.end(), request.bytes, request.bytes + datagram_size);
  };
  // All at once: the download outruns the EEPROM.
  constexpr std::size_t instructions = 200;
  put(downloading, {static_cast<std::uint8_t>(Opcode::enter_download_mode), 0, 0, 0});
  for (std::size_t i = 0; i < instructions; ++i) put(downloading, {static_cast<std::uint8_t>(Opcode::rol), 0, 0, 7});
  put(downloading, {static_cast<std::uint8_t>(Opcode::exit_download_mode), 0, 0, 0});
  bool has_waited = false;
  while (downloading.received.size() < (instructions + 2) * datagram_size) {
    asking.received.clear();
    // A control command: others would go into the program.
    put(asking, {static_cast<std::uint8_t>(Opcode::get_application_status), 0, 0, 0});
    module.wake();
    module.advance_to(module.now());
    EXPECT_EQ(asking.received.size(), datagram_size);
    has_waited = has_waited || module.world().eeprom_busy();
    module.advance_to(module.now() + 300);
    ASSERT_LT(module.now(), 2'000 * one_millisecond);
  }
  EXPECT_TRUE(has_waited);
}

TEST_P(WhileTheEepromIsBusy, NoPageWriteIsLostAndEachTakesItsTime) {
  store_all_variables();
  Microseconds busy = 0;
  const Microseconds begin = bench.module.now();
  while (bench.module.now() - begin < 400 * one_millisecond) {
    if (bench.module.world().eeprom_busy()) busy += 100;
    bench.wait(100);
  }
  EXPECT_EQ(bench.module.world().eeprom().ignored_writes(), 0U);
  EXPECT_FALSE(bench.module.world().eeprom_busy());
  constexpr Microseconds all_writes = (variables - 1) * page_write;
  EXPECT_GE(busy, all_writes - one_millisecond);
}

}  // namespace
}  // namespace opentmcl::tests
