// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/calibrate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>

#include "synthetic_scanner.h"

namespace vitrine::acquisition {
namespace {

using test::ScannerNoise;
using test::SyntheticScanner;
using testing::HasSubstr;

struct TruthError {  // rms errors, in mm, over the area that the calibration covers
  double radial = 0, tangential = 0, axial = 0;
};

// Returns the position errors of the calibration `c` for a grid of pixels. Subtracts the mean
// height error and the mean angle error, because the origins of height and angle are arbitrary.
TruthError error_of(const SyntheticScanner& scanner, const Calibration& c) {
  double radial = 0, tangential = 0, tangential_sum = 0, axial = 0, axial_sum = 0, swings = 0;
  int count = 0;
  for (double v = 5; v < SyntheticScanner::kHeight; v += 20) {
    for (double u = 5; u < SyntheticScanner::kWidth; u += 20) {
      const auto at = c.map.at(u, v);
      if (!at) continue;
      const TablePoint found = about(c.axis, *at);
      const cv::Vec3d truth = scanner.seen(u, v);
      const double distance = scanner.distance(truth);
      if (distance > 45 || distance < 3) continue;
      const double d = std::hypot(found.rho, found.lateral) - distance;
      const double turn = std::remainder(
          std::atan2(found.lateral, found.rho) * 180 / std::numbers::pi - scanner.direction(truth),
          360);
      const double h = found.z - scanner.height(truth);
      radial += d * d;
      axial += h * h;
      axial_sum += h;
      tangential += turn * turn * distance * distance;
      tangential_sum += turn * distance * distance;
      swings += distance * distance;
      ++count;
    }
  }
  if (count == 0) return {9, 9, 9};
  const double mean = axial_sum / count;
  return {
      .radial = std::sqrt(radial / count),
      .tangential =
          std::numbers::pi / 180 *
          std::sqrt(std::max(0.0, tangential - tangential_sum * tangential_sum / swings) / count),
      .axial = std::sqrt(std::max(0.0, axial / count - mean * mean))};
}

// Returns a calibration that is computed once for all tests in this file.
const Expected<Calibrated>& calibrated() {
  static const Expected<Calibrated> result = calibrate(SyntheticScanner().pictures(4, 9, {}), {});
  return result;
}

std::string refusal(const CalibrationInput& input, const CalibrationOptions& options = {}) {
  const auto result = calibrate(input, options);
  return result ? "calibrated" : result.error().message;
}

TEST(Calibrate, RecoversTheScannerFromNoisyPictures) {
  ASSERT_TRUE(calibrated()) << calibrated().error().message;
  const Calibration& c = calibrated()->calibration;
  EXPECT_EQ(c.camera, "CAM-1");
  EXPECT_EQ(c.region, (SensorRegion{0, 0, SyntheticScanner::kWidth, SyntheticScanner::kHeight}));
  EXPECT_FALSE(c.axis.is_clockwise);
  const TruthError error = error_of(SyntheticScanner(), c);
  EXPECT_LT(error.radial, 0.01);
  EXPECT_LT(error.tangential, 0.005);
  EXPECT_LT(error.axial, 0.01);
  // The laser plane is inclined to the axis and does not contain it. [WLL] eq. 1 assumes that the
  // plane contains the axis, so a calibration by this equation alone would be wrong.
  Calibration in_plane = c;
  in_plane.axis.offset = in_plane.axis.tilt = 0;
  EXPECT_GT(error_of(SyntheticScanner(), in_plane).axial, 0.05);
}

TEST(Calibrate, TellsWhichWayTheTableTurns) {
  const SyntheticScanner scanner(true);
  const auto result = calibrate(scanner.pictures(2, 6, {}), {});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->calibration.axis.is_clockwise);
  EXPECT_LT(error_of(scanner, result->calibration).radial, 0.03);
}

TEST(Calibrate, BearsCornersAndStripePointsThatAreFarOff) {
  const SyntheticScanner scanner;
  CalibrationInput input = scanner.pictures(3, 7, {});
  for (TargetPicture& picture : input.pictures) {
    for (std::size_t i = 0; i < picture.view.corners.size(); i += 11)
      picture.view.corners[i].u += 10;
    for (std::size_t i = 0; i < picture.stripe.size(); i += 5)
      picture.stripe[i].u += 40;
  }
  const auto result = calibrate(input, {});
  ASSERT_TRUE(result) << result.error().message;
  const TruthError error = error_of(scanner, result->calibration);
  EXPECT_LT(error.radial, 0.02);
  EXPECT_LT(error.axial, 0.02);
  // A fifth of all points are strays, 40 pixels off. Without strays, the noise would be 0.012 mm.
  EXPECT_LT(result->calibration.noise, 0.03);
}

// Moves every tenth point of every third picture sideways by 6 to 86 pixels.
CalibrationInput with_strays(CalibrationInput input) {
  for (std::size_t i = 0; i < input.pictures.size(); i += 3) {
    std::vector<ImagePoint>& stripe = input.pictures[i].stripe;
    for (std::size_t k = 0; k < stripe.size(); k += 10)
      stripe[k].u += (k / 10 % 2 == 0 ? 1 : -1) * (6 + static_cast<double>(k % 90));
  }
  return input;
}

TEST(Calibrate, JudgesThePosesByTheLaserLineNotByStrays) {
  const CalibrationInput clean = SyntheticScanner().pictures(3, 7, {});
  const auto expected = calibrate(clean, {}), result = calibrate(with_strays(clean), {});
  ASSERT_TRUE(expected && result);
  EXPECT_EQ(expected->report.strays, 0u);
  EXPECT_LT(result->report.residuals.rms, 1.1 * expected->report.residuals.rms);
  EXPECT_LT(result->report.residuals.p95, 1.1 * expected->report.residuals.p95);
  EXPECT_LT(result->report.residuals.max, 1.5 * expected->report.residuals.max);
  EXPECT_EQ(result->report.unclear, 0);
  EXPECT_NEAR(result->report.stray_share(), 0.1 / 3, 0.015);
  const auto json = nlohmann::json::parse(report_json(result->calibration, result->report));
  EXPECT_EQ(json["strays"], result->report.strays);
  EXPECT_EQ(json["stray_share"], result->report.stray_share());
}

TEST(Calibrate, LeavesOutASecondLineOnTheTarget) {
  CalibrationInput input = SyntheticScanner().pictures(3, 7, {});
  const auto expected = calibrate(input, {});
  for (std::size_t i = 0; i < input.pictures.size(); i += 3) {
    std::vector<ImagePoint>& stripe = input.pictures[i].stripe;
    for (std::size_t k = 0; k < stripe.size(); k += 4)  // a reflection, brighter than the line
      stripe[k].u += 30 + 0.1 * static_cast<double>(k);
  }
  const auto result = calibrate(input, {});
  ASSERT_TRUE(expected && result);
  EXPECT_NEAR(result->report.stray_share(), 0.25 / 3, 0.04);
  EXPECT_EQ(result->report.unclear, 0);
  EXPECT_LT(result->report.residuals.max, 1.5 * expected->report.residuals.max);
}

TEST(Calibrate, LeavesOutPicturesWithoutAClearLineAndRefusesMany) {
  CalibrationInput input = SyntheticScanner().pictures(3, 7, {});
  const auto scatter = [](std::vector<ImagePoint>& stripe) {
    for (std::size_t k = 0; k < stripe.size(); ++k)
      if (k % 5 < 2) stripe[k].u += 10 + static_cast<double>(k * 7 % 50);
  };
  scatter(input.pictures[4].stripe);
  const auto result = calibrate(input, {});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->report.unclear, 1);
  EXPECT_GE(result->report.strays, 10u);
  EXPECT_LT(result->report.residuals.max, 0.2);
  for (std::size_t i = 8; i < input.pictures.size(); ++i)
    scatter(input.pictures[i].stripe);
  EXPECT_THAT(refusal(input), HasSubstr("not one straight line in 13 of 20 pictures; keep the"));
}

TEST(Calibrate, ReportsWhatHeldOutPosesSay) {
  ASSERT_TRUE(calibrated());
  const auto& [c, report] = *calibrated();
  EXPECT_EQ(report.pictures, 36);
  EXPECT_EQ(report.held_out.size() > report.points * 9 / 10, true);
  // The stripe's noise of 0.05 pixels is 0.012 mm here. The residuals of the plane map contain this
  // noise.
  EXPECT_NEAR(c.noise, 0.012, 0.002);
  EXPECT_GT(c.residuals.rms, 0.008);
  EXPECT_LT(c.residuals.rms, 0.03);
  EXPECT_LE(c.residuals.rms, c.residuals.p95);
  EXPECT_LT(c.residuals.p95, c.residuals.max);
  EXPECT_NEAR(report.reprojection, 0.05 * std::sqrt(2 * std::log(2)), 0.01);
  EXPECT_NEAR(report.table_error, 0.05, 0.02);
  EXPECT_GT(report.coverage.image_share, 0.15);
  EXPECT_LT(report.coverage.image_share, 1);
  EXPECT_LT(report.coverage.y_low, -30);
  EXPECT_GT(report.coverage.y_high, 30);
  ASSERT_EQ(report.degrees.size(), 4u);
  EXPECT_GT(report.degrees[0].residuals.rms, 3 * report.degrees[1].residuals.rms);
  const DegreeResult& chosen = report.degrees[static_cast<std::size_t>(c.map.degree()) - 2];
  EXPECT_EQ(chosen.residuals.rms, c.residuals.rms);
  EXPECT_LT(report.degrees[1].condition, 40);
}

TEST(Calibrate, JudgesPosesThatItWasNotFittedTo) {
  CalibrationInput input = SyntheticScanner().pictures(2, 6, {.stripe = 0});
  for (ImagePoint& p : input.pictures[8].stripe)
    p.u += 20;  // makes this pose contradict the other poses
  const auto result = calibrate(input, {});
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_GT(result->calibration.residuals.max, 1);
  std::set<int> off;
  for (const HeldOutPoint& p : result->report.held_out) {
    if (p.size() > 0.1) off.insert(p.pose);
  }
  EXPECT_EQ(off.size(), 1u);
}

TEST(Calibrate, HoldsAroundWhatTheStripeWasSeenInToo) {
  const CalibrationInput input = SyntheticScanner().pictures(2, 5, {});
  const auto without = calibrate(input, {.margin = 0}), with = calibrate(input, {.margin = 20});
  ASSERT_TRUE(without && with);
  EXPECT_GT(with->report.coverage.image_share, without->report.coverage.image_share + 0.01);
  EXPECT_LT(error_of(SyntheticScanner(), with->calibration).radial, 0.02);
}

TEST(Calibrate, WritesItsReportAsJsonAndAsAPicture) {
  ASSERT_TRUE(calibrated());
  const auto& [c, report] = *calibrated();
  const auto json = nlohmann::json::parse(report_json(c, report));
  EXPECT_EQ(json["residuals_mm"]["rms"], c.residuals.rms);
  EXPECT_EQ(json["residuals_mm"]["p95"], c.residuals.p95);
  EXPECT_EQ(json["residuals_mm"]["max"], c.residuals.max);
  EXPECT_EQ(json["degrees"].size(), 4u);
  EXPECT_EQ(json["coverage"]["image"], report.coverage.image_share);
  const std::string svg = residual_plot(c, report);
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox="));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
  const auto arrows = std::ranges::count(svg, 'M') - 1;  // the arrow of the scale is not counted
  EXPECT_GT(arrows, 500);
  EXPECT_LE(arrows, 1500);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Calibrate, SaysWhatKeepsItFromTheAxis) {
  const SyntheticScanner scanner;
  EXPECT_THAT(refusal(scanner.pictures(1, 5, {})), HasSubstr("a calibration needs at least 6"));
  CalibrationInput still = scanner.pictures(2, 6, {});
  for (std::size_t i = 0; i < still.pictures.size(); ++i)
    still.pictures[i].placement = static_cast<int>(i);
  EXPECT_THAT(refusal(still), HasSubstr("the table's axis is not determined: stand the target on"));
  CalibrationInput moved = scanner.pictures(2, 6, {});
  std::swap(moved.pictures[1].placement, moved.pictures[8].placement);
  EXPECT_THAT(refusal(moved), HasSubstr("check that the target stood still on the table"));
}

TEST(Calibrate, SaysWhatIsWrongWithTheStripe) {
  const SyntheticScanner scanner;
  CalibrationInput none = scanner.pictures(2, 6, {});
  for (TargetPicture& picture : none.pictures)
    picture.stripe.clear();
  EXPECT_THAT(refusal(none),
              HasSubstr("too little of the laser line is seen on the target; place"));
  CalibrationInput one = none;
  one.pictures[3].stripe = scanner.pictures(2, 6, {}).pictures[3].stripe;
  EXPECT_THAT(refusal(one), HasSubstr("always met the target in the same place"));
}

TEST(Calibrate, RefusesCornersThatTheTargetDoesNotHave) {
  CalibrationInput input = SyntheticScanner().pictures(2, 4, {});
  input.pictures[2].view.ids[5] = 88;
  EXPECT_THAT(refusal(input), HasSubstr("corners that the target does not have"));
  input.target.marker_mm = 80;
  EXPECT_THAT(refusal(input), HasSubstr("markers are smaller than squares"));
}

std::vector<Correspondence> measured_plane() {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<Correspondence> points;
  for (int pose = 0; pose < 12; ++pose) {
    for (int i = 0; i <= 12; ++i) {
      const double u = 100 * pose + 20 * (i % 2), v = 80 * i, s = u / 650 - 1, t = v / 515 - 1;
      points.push_back({u,
                        v,
                        {60 * s + 5 * s * t - 2 * s * s * s + noise(random),
                         -50 * t + 3 * t * t * s + noise(random)},
                        100 - pose});
    }
  }
  return points;
}

TEST(Calibrate, TakesMeasuredPointsAndAnAxisInstead) {
  const TurntableAxis axis{.a = 2, .b = 0.01, .offset = 0.1, .tilt = 0, .is_clockwise = true};
  const SensorRegion region{10, 20, 1300, 1030};
  const auto result = calibrate(measured_plane(), axis, "CAM-7", region, {.degree = 0});
  ASSERT_TRUE(result) << result.error().message;
  const auto& [c, report] = *result;
  EXPECT_EQ(c.map.degree(), 3);
  EXPECT_EQ(c.camera, "CAM-7");
  EXPECT_EQ(c.region, region);
  EXPECT_EQ(c.axis.a, 2);
  EXPECT_TRUE(c.axis.is_clockwise);
  EXPECT_NEAR(c.map.at(650, 515)->x, 0, 0.01);
  EXPECT_NEAR(c.map.at(650, 515)->y, 0, 0.01);
  EXPECT_NEAR(c.residuals.rms, 0.01 * std::sqrt(2), 0.004);
  EXPECT_NEAR(c.noise, 0.01, 0.003);
  EXPECT_EQ(report.pictures, 12);
  EXPECT_EQ(report.degrees.front().degree, 2);
}

TEST(Calibrate, RefusesTooFewMeasuredPosesAndUnknownDegrees) {
  const auto message = [](std::span<const Correspondence> points, int degree) {
    const auto result =
        calibrate(points, TurntableAxis(), "CAM-7", {0, 0, 1300, 1030}, {.degree = degree});
    return result ? "calibrated" : result.error().message;
  };
  const std::vector<Correspondence> points = measured_plane();
  EXPECT_EQ(message(points, 3), "calibrated");
  EXPECT_THAT(message(points, 6), HasSubstr("choose 2 to 5, or 0 for the best"));
  EXPECT_THAT(
      message(std::span(points).first(26), 3),
      HasSubstr("the points have 2 different pose numbers, a calibration needs at least 3"));
  std::vector<Correspondence> apart;  // each pose's points lie outside the hull of all other points
  for (int i = 0; i < 75; ++i) {
    const int pose = i / 25;
    const double u = 40 * (i % 5) + 900 * (pose % 2), v = 40 * (i / 5 % 5) + 700 * (pose / 2);
    apart.push_back({u, v, {u / 10, v / 10}, pose});
  }
  EXPECT_THAT(message(apart, 2), HasSubstr("the calibration cannot be judged"));
}

}  // namespace
}  // namespace vitrine::acquisition
