// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/judge.h"

#include <gmock/gmock.h>

namespace vitrine::acquisition {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string verdict(const Expected<void>& judged) {
  return judged ? "" : judged.error().message;
}

std::vector<StripePoint> stripe(int rows, std::uint8_t flags) {
  std::vector<StripePoint> points;
  for (int row = 0; row < rows; ++row)
    points.push_back({row, 100, 90, flags});
  return points;
}

TEST(Judge, AScanWithAStripeIsFine) {
  EXPECT_EQ(verdict(judge(count(stripe(500, 0)) + count(stripe(100, kSaturated)))), "");
}

TEST(Judge, ARowThatShowsTwoSurfacesIsOneRow) {
  auto points = stripe(2, kSaturated);
  points.insert(points.begin() + 1, {0, 200, 90, kSaturated | kSecond});
  const StripeCount two = count(points);
  EXPECT_EQ(two.rows, 2);
  EXPECT_EQ(two.saturated, 2);
  EXPECT_EQ(two.doubled, 1);
}

TEST(Judge, SharesAreOfAllRowsAndOfThoseWithAStripe) {
  const std::vector<StripeCount> steps = {count(stripe(60, kSaturated)), count(stripe(20, kDouble)),
                                          count({})};
  const RowShares rows = shares(sum(steps), 100);
  EXPECT_DOUBLE_EQ(rows.empty, 220. / 300);
  EXPECT_DOUBLE_EQ(rows.saturated, .75);
  EXPECT_DOUBLE_EQ(rows.doubled, .25);
  EXPECT_EQ(shares({}, 100).doubled, 0);
}

TEST(Judge, NoStripeNamesWhatToDo) {
  EXPECT_THAT(verdict(judge(count({}) + count({}))),
              AllOf(StartsWith("no stripe: 0 rows of 2 pictures"), HasSubstr("laser is on"),
                    HasSubstr("raise the exposure")));
  EXPECT_THAT(verdict(judge(StripeCount{})), StartsWith("no stripe"));
}

TEST(Judge, NoiseInRowsHereAndThereIsNoStripe) {
  std::vector<StripePoint> noise;
  for (int row = 0; row < 500; row += 2)
    noise.push_back({row, 100, 9, 0});
  noise.push_back({499, 900, 9, 0});  // far from the point in the row before
  EXPECT_THAT(verdict(judge(count(noise))), StartsWith("no stripe: 0 rows"));
}

TEST(Judge, OverExposedPicturesAreNotToBeExposedMore) {
  const Frame full{10, 10, std::vector<std::uint8_t>(100, 255)};
  const Frame dark{10, 10, std::vector<std::uint8_t>(100, 12)};
  EXPECT_THAT(verdict(judge(count({}) + count_full(full) + count_full(dark))),
              AllOf(StartsWith("over-exposed: 50 % of all pixels"), HasSubstr("lower the exposure"),
                    Not(HasSubstr("raise"))));
  EXPECT_THAT(verdict(judge(count({}) + count_full(dark) + count_full(dark))),
              StartsWith("no stripe"));
}

TEST(Judge, AllSaturatedNamesWhatToDo) {
  EXPECT_THAT(verdict(judge(count(stripe(500, kSaturated)))),
              AllOf(StartsWith("all saturated: 500 of 500"), HasSubstr("lower the exposure")));
}

TEST(Judge, TwoStripesNameWhatToDo) {
  EXPECT_THAT(verdict(judge(count(stripe(500, kDouble)) + count(stripe(300, 0)))),
              AllOf(StartsWith("two stripes: 500 of 800"), HasSubstr("cover")));
}

TEST(Judge, AFlatScanIsAnEmptyTurntable) {
  const std::vector<Profile> flat(4, Profile{0, {{{10, 0, 1.0}, 7}, {{12, 0, 1.4}, 8}}});
  EXPECT_THAT(verdict(judge(std::span(flat))),
              AllOf(StartsWith("empty turntable: 8 points"), HasSubstr("put an object")));
  const std::vector<Profile> tall(4, Profile{0, {{{10, 0, 1}, 7}, {{10, 0, 9}, 8}}});
  EXPECT_EQ(verdict(judge(std::span(tall))), "");
}

TEST(Judge, AStrayPointIsNoObject) {
  Profile profile{0, std::vector<ProfilePoint>(98, ProfilePoint{{10, 0, 1}, 7})};
  profile.points.push_back({{10, 0, 40}, 300});
  EXPECT_THAT(verdict(judge(std::span(&profile, 1))), StartsWith("empty turntable"));
  profile.points.insert(profile.points.end(), 9, {{10, 0, 40}, 301});
  EXPECT_EQ(verdict(judge(std::span(&profile, 1))), "");
}

TEST(Judge, AScanOutsideTheCalibrationNamesWhatToDo) {
  EXPECT_THAT(verdict(judge(std::span<const Profile>{})), HasSubstr("calibrated region"));
}

}  // namespace
}  // namespace vitrine::acquisition
