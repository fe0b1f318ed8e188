// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

namespace vitrine::acquisition {
namespace {

using testing::HasSubstr;

const CharucoTarget kTarget{
    .squares_x = 9, .squares_y = 12, .square_mm = 8, .marker_mm = 6, .dictionary = "DICT_4X4_100"};

// A picture of the target drawn by OpenCV: in perspective, slightly out of focus and noisy.
struct Picture {
  Frame frame{1300, 1030, {}};
  cv::Matx33d from_mm;

  explicit Picture(std::vector<cv::Point2f> corners, double brightness = 160) {
    const int scale = 20;  // pixels of the drawing per mm
    const int finer = 2;   // oversampling: a pixel is the mean of 2 x 2 samples
    cv::Mat drawing, fine, image;
    cv::aruco::CharucoBoard::create(kTarget.squares_x, kTarget.squares_y, 8, 6,
                                    cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_100))
        ->draw({72 * scale, 96 * scale}, drawing);
    const std::vector<cv::Point2f> outline = {{0, 0}, {72, 0}, {72, 96}, {0, 96}};
    from_mm = cv::Matx33d(cv::Mat(cv::getPerspectiveTransform(outline, corners)));
    const cv::Matx33d to_drawing(scale, 0, -0.5, 0, scale, -0.5, 0, 0, 1);
    const cv::Matx33d to_fine(finer, 0, (finer - 1) / 2.0, 0, finer, (finer - 1) / 2.0, 0, 0, 1);
    cv::warpPerspective(drawing, fine, to_fine * from_mm * to_drawing.inv(),
                        {1300 * finer, 1030 * finer}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, 255);
    cv::resize(fine, image, {1300, 1030}, 0, 0, cv::INTER_AREA);
    image.convertTo(image, CV_64F, brightness / 255, 20);
    cv::GaussianBlur(image, image, {5, 5}, 0.7);
    cv::Mat noise(image.size(), CV_64F);
    cv::RNG(11).fill(noise, cv::RNG::NORMAL, 0, 2);
    image += noise;
    image.convertTo(image, CV_8U);
    frame.pixels.assign(image.datastart, image.dataend);
  }

  ImagePoint of(const TargetPoint& mm) const {
    const cv::Vec3d p = from_mm * cv::Vec3d(mm.x, mm.y, 1);
    return {p[0] / p[2], p[1] / p[2]};
  }
};

double rms_error(const Picture& picture, const TargetView& view) {
  double sum = 0;
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const ImagePoint truth = picture.of(corner_on(kTarget, view.ids[i]));
    sum += std::pow(view.corners[i].u - truth.u, 2) + std::pow(view.corners[i].v - truth.v, 2);
  }
  return std::sqrt(sum / static_cast<double>(view.ids.size()));
}

TEST(CharucoTarget, IsFoundWithinATenthOfAPixel) {
  const Picture pictures[] = {
      Picture({{260.2f, 40.4f}, {1010.7f, 70.1f}, {1000.3f, 990.6f}, {280.9f, 960.2f}}),
      Picture({{420.3f, 110.9f}, {840.8f, 30.2f}, {830.4f, 1000.1f}, {415.6f, 900.7f}})};
  for (const Picture& picture : pictures) {
    const auto view = find_target(picture.frame, kTarget);
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_GE(view->ids.size(), 80u);
    EXPECT_LT(rms_error(picture, *view), 0.1);
  }
}

TEST(CharucoTarget, HalfOutOfThePictureIsStillFound) {
  const Picture picture({{-300.2f, 40.4f}, {410.7f, 70.1f}, {400.3f, 990.6f}, {-280.9f, 960.2f}});
  const auto view = find_target(picture.frame, kTarget);
  ASSERT_TRUE(view) << view.error().message;
  EXPECT_LT(view->ids.size(), 60u);
  EXPECT_LT(rms_error(picture, *view), 0.1);
}

std::string refusal(const Frame& frame, const CharucoTarget& target) {
  const auto view = find_target(frame, target);
  return view ? "found" : view.error().message;
}

TEST(CharucoTarget, NeverSeenIsNamedWithWhatToDo) {
  const Frame dark{1300, 1030, std::vector<std::uint8_t>(1300 * 1030, 3)};
  const Frame bright{1300, 1030, std::vector<std::uint8_t>(1300 * 1030, 255)};
  const Frame grey{1300, 1030, std::vector<std::uint8_t>(1300 * 1030, 128)};
  EXPECT_THAT(refusal(dark, kTarget), HasSubstr("raise the exposure or light the target"));
  EXPECT_THAT(refusal(bright, kTarget), HasSubstr("lower the exposure"));
  EXPECT_THAT(
      refusal(grey, kTarget),
      testing::AllOf(HasSubstr("the target is not seen: 0 of 54 markers and 0 of 88 corners "
                               "found; place it in view"),
                     testing::Not(HasSubstr("exposure"))));
}

TEST(CharucoTarget, OfAnotherDictionaryIsNotTakenForThisOne) {
  const Picture picture({{260, 40}, {1010, 70}, {1000, 990}, {280, 960}});
  CharucoTarget other = kTarget;
  other.dictionary = "DICT_6X6_250";
  EXPECT_THAT(refusal(picture.frame, other), HasSubstr("the target is not seen"));
}

TEST(CharucoTarget, ThatCannotExistIsRefused) {
  const auto message = [](auto change) {
    CharucoTarget target = kTarget;
    change(target);
    const auto ok = check_target(target);
    return ok ? "accepted" : ok.error().message;
  };
  EXPECT_EQ(message([](CharucoTarget&) {}), "accepted");
  EXPECT_THAT(message([](CharucoTarget& t) { t.squares_x = 2; }),
              HasSubstr("3 to 64 in each direction"));
  EXPECT_THAT(message([](CharucoTarget& t) { t.squares_y = 1 << 30; }),
              HasSubstr("3 to 64 in each direction"));
  EXPECT_THAT(message([](CharucoTarget& t) { t.marker_mm = 9; }),
              HasSubstr("smaller than squares"));
  EXPECT_THAT(message([](CharucoTarget& t) { t.square_mm = std::nan(""); }),
              HasSubstr("impossible"));
  EXPECT_THAT(message([](CharucoTarget& t) { t.dictionary = "4x4"; }),
              HasSubstr("\"4x4\" is unknown"));
  EXPECT_THAT(message([](CharucoTarget& t) { t.dictionary = "DICT_4X4_50"; }),
              HasSubstr("50 markers, too"));
}

}  // namespace
}  // namespace vitrine::acquisition
