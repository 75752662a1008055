#include "twin/physics/shaft_encoder.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "twin/physics/shaft.hpp"

namespace opentmcl::twin {
namespace {

using Kind = ShaftEncoder::Kind;
constexpr std::int64_t microsteps_per_count = 50;

TEST(ShaftEncoder, Counts1024InATurn) {
  for (const Kind kind : {Kind::absolute, Kind::incremental}) {
    ShaftEncoder encoder(kind);
    encoder.follow(microsteps_per_turn * 3);
    EXPECT_EQ(encoder.count(), 3 * 1024);
    encoder.follow(-1);
    EXPECT_EQ(encoder.count(), -1);
    encoder.follow(microsteps_per_count - 1);
    EXPECT_EQ(encoder.count(), 0);
  }
}

TEST(ShaftEncoder, KnowsItsAngleAfterPowerOnOnlyWhenItIsAbsolute) {
  ShaftEncoder absolute(Kind::absolute);
  ShaftEncoder incremental(Kind::incremental);
  for (ShaftEncoder* encoder : {&absolute, &incremental}) {
    encoder->follow(-microsteps_per_turn * 7 / 4);
    encoder->power_up();
  }
  EXPECT_EQ(absolute.count(), 256);
  EXPECT_EQ(incremental.count(), 0);
  absolute.follow(-microsteps_per_turn * 2);
  EXPECT_EQ(absolute.count(), 0);
}

TEST(ShaftEncoder, SeesTheNullPositionEvenWhenTheShaftTurnsBackAtOnce) {
  ShaftEncoder encoder(Kind::absolute);
  encoder.follow(-1);
  EXPECT_EQ(encoder.take_null_event(true), std::nullopt);
  encoder.follow(0);
  encoder.follow(-1);
  EXPECT_EQ(encoder.take_null_event(true), 0);
  EXPECT_EQ(encoder.take_null_event(true), std::nullopt) << "taken";
}

TEST(ShaftEncoder, ReportsTheCountOfTheLastNullPositionPassed) {
  ShaftEncoder encoder(Kind::incremental);
  encoder.follow(microsteps_per_count * 100);
  encoder.power_up();
  encoder.follow(microsteps_per_turn * 5 / 2);
  EXPECT_EQ(encoder.take_null_event(false), 2 * 1024 - 100);
  encoder.follow(-microsteps_per_turn / 2);
  EXPECT_EQ(encoder.take_null_event(false), -100);
}

TEST(ShaftEncoder, GivesAnEventInEveryOtherLineAtTheWrongLevelOfTheNullChannel) {
  ShaftEncoder encoder(Kind::incremental);
  int events = 0;
  for (std::int64_t angle = 1; angle <= microsteps_per_turn; ++angle) {
    encoder.follow(angle);
    if (const auto count = encoder.take_null_event(true)) {
      ++events;
      EXPECT_EQ(*count % 4, 0);
      EXPECT_NE(*count % 1024, 0);
    }
  }
  EXPECT_EQ(events, 255);
  EXPECT_EQ(encoder.take_null_event(false), 1024);
}

TEST(ShaftEncoder, IsNearItsNullPositionWithinAFullStep) {
  ShaftEncoder encoder(Kind::absolute);
  for (std::int64_t count = -1024; count <= 2048; ++count) {
    encoder.follow(count * microsteps_per_count);
    const std::int64_t angle = (count + 1024) % 1024;
    EXPECT_EQ(encoder.near_null(), angle <= 5 || angle >= 1024 - 5) << count;
  }
}

using Steps = std::vector<std::int64_t>;

rc::Gen<Steps> any_steps() {
  return rc::gen::container<Steps>(
      rc::gen::oneOf(rc::gen::inRange<std::int64_t>(-700, 700), rc::gen::inRange<std::int64_t>(-150'000, 150'000)));
}

rc::Gen<EncoderProperties> any_incremental() {
  return rc::gen::exec([] {
    EncoderProperties properties;
    properties.lines = *rc::gen::element(1, 2, 100, 256, 500, 2'500);
    properties.reversed = *rc::gen::arbitrary<bool>();
    properties.null_position = *rc::gen::inRange(0, 4 * properties.lines);
    properties.null_width = *rc::gen::inRange(1, std::min(4 * properties.lines, 20));
    properties.null_level = *rc::gen::arbitrary<bool>();
    return properties;
  });
}

rc::Gen<EncoderProperties> any_absolute() {
  return rc::gen::exec([] {
    EncoderProperties properties{.kind = Kind::absolute};
    properties.reversed = *rc::gen::arbitrary<bool>();
    properties.magnet_offset = *rc::gen::inRange(-60'000, 60'000);
    properties.first_harmonic = {*rc::gen::inRange(-3'000, 3'000), *rc::gen::inRange(0, 51'200)};
    properties.second_harmonic = {*rc::gen::inRange(-2'000, 2'000), *rc::gen::inRange(0, 51'200)};
    return properties;
  });
}

/// Levels of the channels at a count above the place where A and B become high together.
struct Channels {
  bool a;
  bool b;
};
Channels channels_at(std::int64_t count) {
  const std::int64_t quarter = ((count % 4) + 4) % 4;
  return {quarter == 0 || quarter == 3, quarter == 0 || quarter == 1};
}

/// A decoder behind wires, microstep by microstep: the reference for the encoder that leaps.
class Decoder {
 public:
  explicit Decoder(const EncoderProperties& properties) : properties_(properties) { look(); }

  void move_to(std::int64_t angle) {
    const std::int64_t turned = properties_.reversed ? -angle : angle;
    place_ = floor_quotient(turned * 4 * properties_.lines, microsteps_per_turn);
    look();
  }
  void break_wire(EncoderChannel channel, bool broken) {
    broken_[static_cast<int>(channel)] = broken;
    look();
  }
  std::int64_t count() const { return count_; }
  std::optional<std::int64_t> take_null_event(bool level) {
    return std::exchange(events_[level ? 1 : 0], std::nullopt);
  }

 private:
  void look() {
    const bool a = channels_at(place_).a || broken_[0];
    const bool b = channels_at(place_).b || broken_[1];
    if (started_) {
      // Forwards A falls while B is high, then B, then A rises while B is low.
      if (a != a_) count_ += a != b ? 1 : -1;
      if (b != b_) count_ += a == b ? 1 : -1;
    }
    const std::int64_t turn = 4 * properties_.lines;
    const std::int64_t beyond = (((place_ - properties_.null_position) % turn) + turn) % turn;
    const bool n = broken_[2] || (beyond < properties_.null_width) == properties_.null_level;
    for (const bool level : {false, true}) {
      const bool shows = a && b && n == level;
      if (started_ && shows && !shows_[level ? 1 : 0]) events_[level ? 1 : 0] = count_;
      shows_[level ? 1 : 0] = shows;
    }
    a_ = a;
    b_ = b;
    started_ = true;
  }

  EncoderProperties properties_;
  std::int64_t place_ = 0;
  std::int64_t count_ = 0;
  bool started_ = false;
  bool a_ = false;
  bool b_ = false;
  bool shows_[2] = {};
  bool broken_[3] = {};
  std::optional<std::int64_t> events_[2];
};

RC_GTEST_PROP(ShaftEncoder, CountsAndSeesInLeapsWhatADecoderDoesInMicrosteps, ()) {
  const EncoderProperties properties = *any_incremental();
  ShaftEncoder encoder(properties);
  Decoder decoder(properties);
  std::int64_t angle = 0;
  for (const std::int64_t step : *any_steps()) {
    if (*rc::gen::inRange(0, 4) == 0) {
      const auto channel = *rc::gen::element(EncoderChannel::a, EncoderChannel::b, EncoderChannel::n);
      const bool broken = *rc::gen::arbitrary<bool>();
      encoder.break_wire(channel, broken);
      decoder.break_wire(channel, broken);
      RC_ASSERT(encoder.count() == decoder.count());
    }
    const std::int64_t target = angle + step;
    RC_ASSERT(encoder.count_at(angle) == encoder.count());
    encoder.follow(target);
    while (angle != target) decoder.move_to(angle += target > angle ? 1 : -1);
    RC_ASSERT(encoder.count() == decoder.count());
    const bool level = *rc::gen::arbitrary<bool>();
    RC_ASSERT(encoder.take_null_event(level) == decoder.take_null_event(level));
  }
}

RC_GTEST_PROP(ShaftEncoder, MeasuresAWholeTurnWithABoundedErrorThatComesAgainEachTurn, ()) {
  const EncoderProperties properties = *any_absolute();
  const ShaftEncoder encoder(properties);
  EncoderProperties ideal_properties = properties;
  ideal_properties.first_harmonic = ideal_properties.second_harmonic = {};
  const ShaftEncoder ideal(ideal_properties);
  const std::int64_t shift = ideal.count() - encoder.count();  // their turns may begin at different ones
  const auto angle = *rc::gen::inRange<std::int64_t>(-200'000, 200'000);
  const std::int64_t largest =
      (std::abs(properties.first_harmonic.amplitude) + std::abs(properties.second_harmonic.amplitude)) / 50 + 2;
  const std::int64_t error = encoder.count_at(angle) - ideal.count_at(angle) + shift;
  RC_ASSERT(std::abs(error) <= 2 * largest);
  const std::int64_t direction = properties.reversed ? -1 : 1;
  RC_ASSERT(encoder.count_at(angle + microsteps_per_turn) - encoder.count_at(angle) == direction * 1024);
  RC_ASSERT((encoder.count_at(angle + 1) - encoder.count_at(angle)) * direction >= 0);
}

TEST(ShaftEncoder, MeasuresOneOrTwoSinesATurnWithAMagnetThatIsNotQuiteRight) {
  EncoderProperties off_axis{.kind = Kind::absolute};
  off_axis.first_harmonic = {.amplitude = 500, .phase = 0};  // 10 counts
  EncoderProperties not_round{.kind = Kind::absolute};
  not_round.second_harmonic = {.amplitude = 500, .phase = microsteps_per_turn / 4};
  struct Row {
    std::int64_t count;
    std::int64_t error_off_axis;
    std::int64_t error_not_round;
  };
  for (const Row& row : {Row{0, 0, 10}, {128, 7, 0}, {256, 10, -10}, {512, 0, 10}, {768, -10, -10}, {896, -7, 0}}) {
    const std::int64_t angle = row.count * microsteps_per_count;
    EXPECT_LE(std::abs(ShaftEncoder(off_axis).count_at(angle) - row.count - row.error_off_axis), 1) << row.count;
    const ShaftEncoder second(not_round);
    EXPECT_LE(std::abs(second.count_at(angle) - row.count - row.error_not_round), 1) << row.count;
  }
}

RC_GTEST_PROP(ShaftEncoder, HasItsNullPositionWhereItSays, ()) {
  const EncoderProperties properties = *rc::gen::oneOf(any_incremental(), any_absolute());
  ShaftEncoder encoder(properties);
  const auto angle = *rc::gen::inRange<std::int64_t>(-100'000, 100'000);
  const std::int64_t turn = encoder.counts_per_turn();
  const std::int64_t zero = properties.kind == Kind::absolute ? 0 : properties.null_position;
  const std::int64_t width = properties.kind == Kind::absolute ? 1 : properties.null_width;
  const auto in_null = [&](std::int64_t at) { return floor_remainder(encoder.count_at(at) - zero, turn) < width; };
  const EventDistance distance = encoder.null_distance(angle);
  RC_ASSERT(distance.up > 0 && distance.up <= microsteps_per_turn + 16'000);
  RC_ASSERT(distance.down > 0);
  RC_ASSERT(in_null(angle + distance.up) != in_null(angle));
  RC_ASSERT(in_null(angle + distance.up - 1) == in_null(angle));
  RC_ASSERT(in_null(angle - distance.down) != in_null(angle));
  RC_ASSERT(in_null(angle - distance.down + 1) == in_null(angle));
}

RC_GTEST_PROP(ShaftEncoder, GoesOnFromASavedStateAsIfNothingHadBeen, ()) {
  const EncoderProperties properties = *rc::gen::oneOf(any_incremental(), any_absolute());
  ShaftEncoder encoder(properties);
  encoder.break_wire(EncoderChannel::a, *rc::gen::arbitrary<bool>());
  std::int64_t angle = 0;
  for (const std::int64_t step : *any_steps()) encoder.follow(angle += step);
  ShaftEncoder restored(properties);
  restored.restore(encoder.state());
  for (const std::int64_t step : *any_steps()) {
    angle += step;
    encoder.follow(angle);
    restored.follow(angle);
    RC_ASSERT(restored.count() == encoder.count());
    RC_ASSERT(restored.take_null_event(true) == encoder.take_null_event(true));
  }
}

TEST(ShaftEncoder, GoesBackAndForthByOneCountWithOneChannelAlone) {
  for (const EncoderChannel channel : {EncoderChannel::a, EncoderChannel::b}) {
    ShaftEncoder encoder(Kind::incremental);
    encoder.break_wire(channel, true);
    for (std::int64_t angle = 0; angle < microsteps_per_turn; angle += microsteps_per_count) {
      encoder.follow(angle);
      EXPECT_LE(std::abs(encoder.count()), 1);
    }
    encoder.break_wire(channel, false);
    encoder.follow(2 * microsteps_per_turn);
    EXPECT_LE(std::abs(encoder.count() - 1024), 2) << "counts again, a turn behind";
  }
}

TEST(ShaftEncoder, MissesItsNullPositionWithTheWireOfNBroken) {
  ShaftEncoder encoder(Kind::incremental);
  encoder.break_wire(EncoderChannel::n, true);
  encoder.follow(3 * microsteps_per_turn);
  EXPECT_EQ(encoder.take_null_event(false), std::nullopt);
  EXPECT_EQ(encoder.take_null_event(true), 3 * 1024) << "sees it in every line when told the other level";
}

}  // namespace
}  // namespace opentmcl::twin
