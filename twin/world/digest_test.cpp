#include "twin/world/digest.hpp"

#include <gtest/gtest.h>

#include "twin/world/world_test_bench.hpp"

namespace opentmcl::twin {
namespace {

TEST(Digest, IsTheOneThatItsAuthorsPublished) {
  Digest digest;
  EXPECT_EQ(0xCBF29CE484222325U, digest.value());
  constexpr std::uint8_t letters[] = {'f', 'o', 'o', 'b', 'a', 'r'};
  digest.add(letters);
  EXPECT_EQ(0x85944171F73967E8U, digest.value());
}

TEST(DigestOfAWorld, IsTheSameForTwoThatWereTreatedAlike) {
  World one;
  World other;
  for (World* world : {&one, &other}) {
    world->set_left_switch(true);
    world->advance_to(1000);
  }
  EXPECT_EQ(digest_of(one), digest_of(other));
}

TEST(DigestOfAWorld, DoesNotDependOnHowTimeIsCut) {
  World whole;
  whole.advance_to(1000);
  World cut;
  for (Tick tick = 0; tick <= 1000; tick += 8) cut.advance_to(tick);
  EXPECT_EQ(digest_of(whole), digest_of(cut));
}

TEST(DigestOfAWorld, ChangesWithTimeQuantitiesRegistersAndEeprom) {
  World world;
  std::uint64_t before = digest_of(world);
  const auto expect_change = [&](const char* what) {
    const std::uint64_t now = digest_of(world);
    EXPECT_NE(before, now) << what;
    before = now;
  };
  world.advance_to(1);
  expect_change("time");
  world.set_analog_input(2, 77);
  expect_change("a quantity");
  world.transfer_tmc429(tmc429::write_datagram<tmc429::MaximumVelocity>(tmc429::MaximumVelocity::Value::of(17), 2));
  expect_change("a register of the TMC429");
  world.transfer_tmc262(tmc262::datagram(tmc262::ChopperConfiguration::OffTime::of(3)));
  expect_change("a register of the TMC262");
  constexpr std::uint8_t byte = 0;
  world.write_eeprom_page(5000, &byte, 1);
  world.advance_to(world.now() + Eeprom::page_write_clocks);
  expect_change("the EEPROM");
}

}  // namespace
}  // namespace opentmcl::twin
