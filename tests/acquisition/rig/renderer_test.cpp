// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/rig_scenes.h"

namespace vitrine::acquisition::rig::test {
namespace {

const Solid& pebble() {
  static const Solid solid(ball({2, 0, 40}, 30, 120));
  return solid;
}

Frame shown(const Realism& realism, const Setting& setting, const Exposure& exposure = {}) {
  return Renderer(optics_of(realism.seed), &pebble(), realism).take({setting, exposure});
}

TEST(Renderer, TheSameSettingGivesTheSamePictureWhateverCameBefore) {
  Renderer one(optics_of(5), &pebble(), {.seed = 5}), other(optics_of(5), &pebble(), {.seed = 5});
  one.take({at(30, false)});
  one.take({at(12.5, true)});
  EXPECT_EQ(one.take({at(77.25, true)}), other.take({at(77.25, true)}));
  // These two angles differ by one revolution, so the pictures must be equal.
  EXPECT_EQ(one.take({at(-282.75, true)}), other.take({at(77.25, true)}));
}

TEST(Renderer, TurnsDoNotShowButAngleLaserAndSeedDo) {
  Setting later = at(10, true);
  later.turns = 99;
  EXPECT_EQ(shown({.seed = 5}, at(10, true)), shown({.seed = 5}, later));
  EXPECT_NE(shown({.seed = 5}, at(10, true)), shown({.seed = 5}, at(10.5, true)));
  EXPECT_NE(shown({.seed = 5}, at(10, false)), shown({.seed = 5}, at(10.5, false)));
  EXPECT_NE(shown({.seed = 5}, at(10, true)), shown({.seed = 5}, at(10, false)));
  EXPECT_NE(shown({.seed = 5}, at(10, true)), shown({.seed = 6}, at(10, true)));
}

TEST(Renderer, ALaserThatCreptMovesTheStripe) {
  Renderer renderer(optics_of(1), &pebble(), ideal());
  const Frame before = renderer.take({at(0, true)});
  const Shot shot{.setting = at(0, true), .laser_shift = 0.5};
  EXPECT_NE(before, renderer.take(shot));
}

TEST(Renderer, PixelsHaveReadNoiseOfTwoGreyLevelsAtLeast) {
  Renderer renderer(optics_of(1), nullptr, {.seed = 1});
  const Frame frame = renderer.take({at(0, false)});
  double sum = 0, squares = 0;
  for (const std::uint8_t level : frame.pixels) {
    sum += level;
    squares += level * level;
  }
  const double count = static_cast<double>(frame.pixels.size()), mean = sum / count;
  EXPECT_NEAR(mean, 9.5, 0.1);
  EXPECT_GE(std::sqrt(squares / count - mean * mean), 2);
  EXPECT_LE(std::sqrt(squares / count - mean * mean), 2.4);
}

TEST(Renderer, BothFramesOfAPairHaveNoiseOfTheirOwn) {
  Renderer renderer(optics_of(1), nullptr, {.seed = 1});
  EXPECT_NE(renderer.take({at(0, false)}), renderer.take({at(0, true)}));
}

int brightest(const Frame& frame) {
  return *std::max_element(frame.pixels.begin(), frame.pixels.end());
}

TEST(Renderer, LightGrowsWithExposureAndGain) {
  const int once = brightest(shown(ideal(), at(0, true), {.us = 1000})) - 8;
  EXPECT_NEAR(brightest(shown(ideal(), at(0, true), {.us = 2000})) - 8, 2 * once, 2);
  EXPECT_NEAR(
      brightest(shown(ideal(), at(0, true), {.us = 1000, .gain_db = 20 * std::log10(3)})) - 8,
      3 * once, 3);
}

TEST(Renderer, TheStripeIsWellWithinRangeAtTheUsualExposure) {
  const int level = brightest(shown(ideal(), at(0, true)));
  EXPECT_GT(level, 100);
  EXPECT_LT(level, 255);
}

std::ptrdiff_t saturated(const Frame& frame) {
  return std::count(frame.pixels.begin(), frame.pixels.end(), 255);
}

TEST(Renderer, ExposureReachesFromNoStripeToAllSaturated) {
  EXPECT_LE(brightest(shown(ideal(), at(0, true), {.us = 20})), 9);
  EXPECT_EQ(saturated(shown({.seed = 1}, at(0, false))), 0);
  const Frame flooded = shown({.seed = 1}, at(0, true), {.us = 2'000'000});
  EXPECT_EQ(saturated(flooded), static_cast<std::ptrdiff_t>(flooded.pixels.size()));
}

TEST(Renderer, ARegionIsThatPartOfTheWholeFrame) {
  Renderer renderer(optics_of(1), &pebble(), {.seed = 1});
  const Frame whole = renderer.take({at(45, true)});
  const SensorRegion region{403, 250, 301, 200};
  const Frame part = renderer.take({at(45, true), {}, region});
  ASSERT_EQ(part.width, 301);
  ASSERT_EQ(part.height, 200);
  for (int v = 0; v < part.height; ++v) {
    const auto row = part.row(v), same = whole.row(v + region.y).subspan(403, 301);
    ASSERT_TRUE(std::equal(row.begin(), row.end(), same.begin(), same.end())) << v;
  }
}

TEST(Renderer, AnEmptyTableShowsNoLight) {
  Renderer renderer(optics_of(1), nullptr, ideal());
  EXPECT_LE(brightest(renderer.take({at(0, true)})), 10);
}

TEST(Renderer, TheMotorErrsByFiveHundredthsOfADegreeAndRepeats) {
  const Realism realism{.seed = 9};
  double squares = 0, sum = 0;
  constexpr int kSteps = 4000;
  for (int step = 0; step < kSteps; ++step) {
    const double degrees = step * 360.0 / kSteps, error = reached(realism, degrees) - degrees;
    EXPECT_NEAR(reached(realism, degrees + 360) - degrees - 360, error, 1e-9) << degrees;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / kSteps, 0, 0.004);
  EXPECT_NEAR(std::sqrt(squares / kSteps), 0.05, 0.003);
  EXPECT_EQ(reached(ideal(), 12.5), 12.5);
}

}  // namespace
}  // namespace vitrine::acquisition::rig::test
