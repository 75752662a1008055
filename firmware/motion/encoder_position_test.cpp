#include "firmware/motion/encoder_position.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <optional>
#include <vector>

namespace opentmcl {
namespace {

/// An encoder that the test turns.
class TurnedEncoder final : public hal::Encoder {
 public:
  std::int32_t count() override { return static_cast<std::int32_t>(static_cast<std::uint32_t>(total)); }
  bool take_null_event(bool high_active, std::int32_t& count) override {
    std::optional<std::int32_t>& event = null_events[high_active ? 1 : 0];
    if (!event) return false;
    count = *event;
    event.reset();
    return true;
  }

  std::int64_t total = 0;
  std::optional<std::int32_t> null_events[2];  ///< of a low and of a high active N channel
};

struct EncoderPositionTest : testing::Test {
  void set_prescaler(std::int32_t value) {
    settings.set(AxisParameter::encoder_prescaler, value);
    position.apply_prescaler();
  }

  ModuleId module = ModuleId::tmcm1110;
  TurnedEncoder encoder;
  AxisSettings settings{module};
  EncoderPosition position{module, settings, encoder};
};

constexpr std::int32_t clear_on_null = 4;
constexpr std::int32_t every_time = 8;
constexpr std::int32_t high_active = 16;

TEST_F(EncoderPositionTest, IsFiftyMicrostepsACountByDefault) {
  position.initialise();
  encoder.total = 1024;
  EXPECT_EQ(position.position(), 51200);
  encoder.total = -3;
  EXPECT_EQ(position.position(), -150);
}

TEST_F(EncoderPositionTest, StartsAtZeroWhereverTheEncoderStands) {
  encoder.total = 777;
  position.initialise();
  EXPECT_EQ(position.position(), 0);
}

RC_GTEST_PROP(EncoderPosition, IsTheExactProductAfterAnyWay, ()) {
  TurnedEncoder encoder;
  AxisSettings settings{ModuleId::tmcm1110};
  EncoderPosition position{ModuleId::tmcm1110, settings, encoder};
  const std::int64_t factor = *rc::gen::arbitrary<std::int32_t>() & ~(clear_on_null | every_time | high_active);
  settings.set(AxisParameter::encoder_prescaler, static_cast<std::int32_t>(factor));
  position.initialise();
  const auto begin = *rc::gen::arbitrary<std::int32_t>();
  position.set_position(begin);
  const auto ways = *rc::gen::container<std::vector<std::int32_t>>(rc::gen::arbitrary<std::int32_t>());
  for (const std::int32_t way : ways) {
    // No more than 2^31 - 1 counts between two looks.
    encoder.total += way == int32_minimum ? 0 : way;
    // In whole microsteps for every 512 counts, then the fraction of the rest.
    const std::int64_t whole = encoder.total >> 9;
    const std::int64_t rest = encoder.total & 511;
    const std::uint64_t expected = static_cast<std::uint64_t>(begin) +
                                   static_cast<std::uint64_t>(whole) * static_cast<std::uint64_t>(factor) +
                                   static_cast<std::uint64_t>((rest * factor) >> 9);
    RC_ASSERT(position.position() == static_cast<std::int32_t>(static_cast<std::uint32_t>(expected)));
  }
}

TEST_F(EncoderPositionTest, DoesNotDriftInTenMillionLooksAtAFractionOfAMicrostep) {
  set_prescaler(1);
  position.initialise();
  for (int look = 0; look < 10'000'000; ++look) {
    ++encoder.total;
    position.follow();
  }
  EXPECT_EQ(position.position(), 10'000'000 / 512);
}

TEST_F(EncoderPositionTest, ContinuesFromThePositionThatIsWritten) {
  position.initialise();
  encoder.total = 10;
  position.set_position(-1'000'000);
  encoder.total = 12;
  EXPECT_EQ(position.position(), -999'900);
}

TEST_F(EncoderPositionTest, KeepsItsPositionWhenThePrescalerChanges) {
  position.initialise();
  encoder.total = 100;
  set_prescaler(512);
  EXPECT_EQ(position.position(), 5000);
  encoder.total = 101;
  EXPECT_EQ(position.position(), 5001);
}

TEST_F(EncoderPositionTest, CountsTheOtherWayWhenReversed) {
  position.initialise();
  encoder.total = 10;
  position.set_reversed(true);
  EXPECT_EQ(position.position(), 500) << "what was counted stays";
  encoder.total = 14;
  EXPECT_EQ(position.position(), 300);
  EXPECT_EQ(position.absolute_angle(), 1024 - 14);
}

TEST_F(EncoderPositionTest, IgnoresNullEventsUnlessToldToClear) {
  position.initialise();
  encoder.total = 10;
  encoder.null_events[0] = 5;
  EXPECT_EQ(position.position(), 500);
  set_prescaler(512 | clear_on_null);
  EXPECT_EQ(position.position(), 500) << "the event was before";
}

TEST_F(EncoderPositionTest, ClearsOnceAtTheNextNullEventOfATmcm1110) {
  set_prescaler(512 | clear_on_null);
  position.initialise();
  encoder.total = 10;
  encoder.null_events[0] = 7;
  EXPECT_EQ(position.position(), 3);
  EXPECT_EQ(settings[AxisParameter::encoder_prescaler], 512) << "done";
  encoder.total = 20;
  encoder.null_events[0] = 15;
  EXPECT_EQ(position.position(), 13);
}

TEST_F(EncoderPositionTest, ClearsAtEveryNullEventWithBothBits) {
  set_prescaler(512 | clear_on_null | every_time);
  position.initialise();
  for (const std::int32_t null : {100, 200, 150}) {
    encoder.total = null + 4;
    encoder.null_events[0] = null;
    EXPECT_EQ(position.position(), 4);
  }
}

TEST_F(EncoderPositionTest, LooksAtTheLevelOfTheNullChannelThatCounts) {
  set_prescaler(512 | clear_on_null | every_time | high_active);
  position.initialise();
  encoder.total = 9;
  encoder.null_events[0] = 3;
  EXPECT_EQ(position.position(), 9);
  encoder.null_events[1] = 5;
  EXPECT_EQ(position.position(), 4);
}

TEST(SensOstep, ClearsAtEveryPassOfItsZero) {
  TurnedEncoder encoder;
  AxisSettings settings{ModuleId::pd1161};
  EncoderPosition position{ModuleId::pd1161, settings, encoder};
  settings.set(AxisParameter::encoder_prescaler, 25600 | clear_on_null);
  position.initialise();
  for (const std::int32_t null : {1024, 2048, 1024}) {
    encoder.total = null + 2;
    encoder.null_events[0] = null;
    EXPECT_EQ(position.position(), 100);
  }
  EXPECT_EQ(settings[AxisParameter::encoder_prescaler], 25600 | clear_on_null);
}

TEST(SensOstep, MatchesEveryMicrostepResolutionByTheManualsTable) {
  constexpr std::int32_t prescalers[] = {200, 400, 800, 1600, 3200, 6400, 12800, 25600};  // from 2 microsteps on
  for (int resolution = 1; resolution <= 8; ++resolution) {
    TurnedEncoder encoder;
    AxisSettings settings{ModuleId::pd1161};
    EncoderPosition position{ModuleId::pd1161, settings, encoder};
    settings.set(AxisParameter::encoder_prescaler, prescalers[resolution - 1]);
    position.initialise();
    encoder.total = 7 * 1024;
    EXPECT_EQ(position.position(), 7 * (200 << resolution)) << "2^" << resolution << " microsteps";
  }
}

}  // namespace
}  // namespace opentmcl
