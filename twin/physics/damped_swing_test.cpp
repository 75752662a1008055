#include "twin/physics/damped_swing.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace opentmcl::twin {
namespace {

struct Case {
  double decay;
  double frequency;
  Swing swing;
};

Case arbitrary_case() {
  const double frequency = *rc::gen::inRange(100, 3000);
  return {frequency * *rc::gen::inRange(1, 50) * 1e-2,
          frequency,
          {*rc::gen::inRange(-1000, 1000) * 1e-3, *rc::gen::inRange(-1000, 1000) * 1.0}};
}

RC_GTEST_PROP(DampedOscillator, ObeysItsEquation, ()) {
  const auto [decay, frequency, swing] = arbitrary_case();
  const DampedOscillator oscillator(decay, frequency);
  const double time = *rc::gen::inRange(0, 100) * 1e-4;
  const double step = 1e-3 / frequency;
  const Swing before = oscillator.after(swing, time);
  const Swing now = oscillator.after(swing, time + step);
  const Swing next = oscillator.after(swing, time + 2 * step);
  // x'' + 2 b x' + w² x = 0 by central differences, against the largest term
  const double acceleration = (next.rate - before.rate) / (2 * step);
  const double scale = frequency * frequency * oscillator.amplitude(swing) + 1e-9;
  RC_ASSERT(std::fabs(acceleration + 2 * decay * now.rate + frequency * frequency * now.deviation) < 2e-5 * scale);
  RC_ASSERT(std::fabs((next.deviation - before.deviation) / (2 * step) - now.rate) < 2e-5 * scale / frequency);
}

RC_GTEST_PROP(DampedOscillator, GoesOnWhereItWasCut, ()) {
  const auto [decay, frequency, swing] = arbitrary_case();
  const DampedOscillator oscillator(decay, frequency);
  const double first = *rc::gen::inRange(0, 100) * 1e-4;
  const double second = *rc::gen::inRange(0, 100) * 1e-4;
  const Swing at_once = oscillator.after(swing, first + second);
  const Swing cut = oscillator.after(oscillator.after(swing, first), second);
  const double scale = oscillator.amplitude(swing) + 1e-9;
  RC_ASSERT(std::fabs(at_once.deviation - cut.deviation) < 1e-7 * scale);
  RC_ASSERT(std::fabs(at_once.rate - cut.rate) < 1e-7 * scale * frequency);
}

RC_GTEST_PROP(DampedOscillator, KnowsWhenItTurnsNext, ()) {
  const auto [decay, frequency, swing] = arbitrary_case();
  RC_PRE(swing.rate != 0);
  const DampedOscillator oscillator(decay, frequency);
  const double time = oscillator.time_to_turn(swing);
  RC_ASSERT(time > 0);
  RC_ASSERT(std::fabs(oscillator.after(swing, time).rate) < 1e-7 * frequency * (oscillator.amplitude(swing) + 1e-9));
  // Not before: the rate has kept its sign.
  RC_ASSERT(oscillator.after(swing, 0.99 * time).rate * swing.rate > 0);
}

TEST(DampedOscillator, TurnsAfterHalfAPeriodFromRest) {
  const DampedOscillator oscillator(0, 100);
  EXPECT_NEAR(oscillator.time_to_turn({1, 0}), M_PI / 100, 1e-12);
  EXPECT_NEAR(oscillator.after({1, 0}, M_PI / 100).deviation, -1, 1e-8);
}

}  // namespace
}  // namespace opentmcl::twin
