#include "twin/physics/ideal_rotor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace opentmcl::twin {
namespace {

TEST(IdealRotor, CountsWholeTurnsOfTheFieldInBothDirections) {
  IdealRotor rotor;
  for (std::uint32_t step = 1; step <= 3000; ++step) {
    rotor.follow(step % IdealRotor::field_turn);
  }
  EXPECT_EQ(rotor.angle(), 3000);
  for (std::uint32_t step = 3000; step-- > 0;) {
    rotor.follow(step % IdealRotor::field_turn);
  }
  EXPECT_EQ(rotor.angle(), 0);
}

TEST(IdealRotor, FollowsNegativeAngles) {
  IdealRotor rotor;
  rotor.follow(IdealRotor::field_turn - 256);
  EXPECT_EQ(rotor.angle(), -256);
}

TEST(IdealRotor, LosesFourFullStepsForEveryTurnOfTheFieldAtAHardEnd) {
  constexpr std::int64_t end = 300;
  constexpr std::uint32_t turns = 5;
  IdealRotor rotor(-end, end);
  std::uint32_t field = 0;
  while (field < end + turns * IdealRotor::field_turn) {
    rotor.follow(++field % IdealRotor::field_turn);
    EXPECT_LE(rotor.angle(), end);
    EXPECT_GE(rotor.angle(), end - 512) << "falls back by half a turn of the field and comes again";
  }
  EXPECT_EQ(rotor.angle(), end);
  for (int step = 0; step < 100; ++step) rotor.follow(--field % IdealRotor::field_turn);
  EXPECT_EQ(rotor.angle(), end - 100) << "follows again, five turns of the field behind";
}

RC_GTEST_PROP(IdealRotor, AlwaysStandsAtTheFieldAndNeverTurnsMoreThanHalfWay, ()) {
  IdealRotor rotor;
  for (const auto raw : *rc::gen::arbitrary<std::vector<std::uint16_t>>()) {
    const std::uint32_t field = raw % IdealRotor::field_turn;
    const std::int64_t before = rotor.angle();
    rotor.follow(field);
    RC_ASSERT(static_cast<std::uint64_t>(rotor.angle()) % IdealRotor::field_turn == field);
    RC_ASSERT(std::abs(rotor.angle() - before) <= 512);
  }
}

}  // namespace
}  // namespace opentmcl::twin
