// SPDX-License-Identifier: Apache-2.0
// Tests the failures of picture_target(). The tests with vitrine-rig cover its normal use.
#include "acquisition/session/target_pictures.h"

#include "scan_test.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

const CharucoTarget kTarget{
    .squares_x = 9, .squares_y = 14, .square_mm = 8, .marker_mm = 6, .dictionary = "DICT_4X4_100"};

PlaceTarget places(int count) {
  return [count](int number) -> Expected<bool> { return number < count; };
}

TEST_F(ScanTest, ATargetThatIsNeverSeenIsNamed) {
  EmergencyStop stop;
  const auto none = picture_target(scanner(), kTarget, places(2), stop);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("target never seen: "));
}

TEST_F(ScanTest, APlaceWhereTheTargetIsNotSeenSaysWhyAtOnce) {
  EmergencyStop stop;
  std::vector<std::string> told;
  TargetPictureOptions options;
  options.progress = [&](const std::string& seen) { told.push_back(seen); };
  const auto none = picture_target(scanner(), kTarget, places(2), stop, options);
  ASSERT_EQ(told.size(), 2u);
  const std::string said = "2 places, 0 pictures that show the target; not at this place: ";
  ASSERT_THAT(told.back(), testing::StartsWith(said));
  EXPECT_EQ(none.error().message, "target never seen: " + told.back().substr(said.size()));
}

TEST_F(ScanTest, AnOperatorWhoPlacesNoTargetIsTold) {
  EmergencyStop stop;
  EXPECT_THAT(picture_target(scanner(), kTarget, places(0), stop).error().message,
              HasSubstr("it was never placed; put it on the table"));
}

TEST_F(ScanTest, LaserAndMotorRestWhileHandsAreAtTheTable) {
  EmergencyStop stop;
  const PlaceTarget place = [&](int number) -> Expected<bool> {
    const std::lock_guard lock(world_.mutex);
    EXPECT_FALSE(world_.laser || world_.motor);
    EXPECT_EQ(world_.degrees, 0);
    return number < 2;
  };
  EXPECT_FALSE(picture_target(scanner(), kTarget, place, stop));
}

TEST_F(ScanTest, ADeviceLostDuringCalibrationIsTheError) {
  world_.fault = [](const std::string& call, int count) { return call == "capture" && count == 5; };
  EmergencyStop stop;
  EXPECT_THAT(picture_target(scanner(), kTarget, places(3), stop).error().message,
              HasSubstr("is gone at \"capture\""));
}

}  // namespace
}  // namespace vitrine::test
