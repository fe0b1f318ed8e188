// SPDX-License-Identifier: Apache-2.0
#include "acquisition/profile/sampling.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace vitrine::acquisition {
namespace {

Profile profile_of(const std::vector<double>& rho) {
  Profile profile{12, {}};
  for (std::size_t i = 0; i < rho.size(); ++i)
    profile.points.push_back({{rho[i], 0, -.1 * static_cast<double>(i)}, static_cast<int>(i)});
  return profile;
}

Profile sampled(Profile profile, const SamplingOptions& options) {
  sample({&profile, 1}, options);
  return profile;
}

std::vector<double> rhos(const Profile& profile) {
  std::vector<double> values;
  for (const ProfilePoint& p : profile.points)
    values.push_back(p.at.rho);
  return values;
}

TEST(EquidistantSampling, KeepsEveryLthPoint) {
  const Profile kept = sampled(profile_of({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}),
                               {.method = SamplingMethod::kEquidistant, .window = 5});
  EXPECT_THAT(rhos(kept), testing::ElementsAre(0, 5, 10));
  EXPECT_EQ(kept.theta, 12);
}

TEST(PaperSampling, ABlockWithinThreeSigmaBecomesItsMean) {
  const Profile kept =
      sampled(profile_of({1, 2, 3, 4, 5, 10, 20}), {.method = SamplingMethod::kPaper, .window = 5});
  ASSERT_EQ(kept.points.size(), 2);
  EXPECT_DOUBLE_EQ(kept.points[0].at.rho, 3);
  EXPECT_NEAR(kept.points[0].at.z, -.2, 1e-12);
  EXPECT_EQ(kept.points[0].row, 2);
  EXPECT_DOUBLE_EQ(kept.points[1].at.rho, 15);  // mean of the two points in the last block
  EXPECT_NEAR(kept.points[1].at.z, -.55, 1e-12);
}

// One of 15 points is off by 1. Its distance from the mean, 14/15 = .9333, exceeds three standard
// deviations, .7746.
TEST(PaperSampling, ABlockWithAPointBeyondThreeSigmaStaysAsItIs) {
  std::vector<double> rho(30, 10);
  rho[7] = 11;
  const Profile kept = sampled(profile_of(rho), {.method = SamplingMethod::kPaper, .window = 15});
  ASSERT_EQ(kept.points.size(), 16);
  EXPECT_EQ(kept.points[7].at.rho, 11);
  EXPECT_EQ(kept.points[15].at.rho, 10);
}

// In n points, no value deviates from the mean by more than (n - 1) / sqrt(n) standard deviations.
// Up to n = 10, this is less than 3, so outliers are averaged too.
TEST(PaperSampling, UpToTenPointsNothingIsEverBeyondThreeSigma) {
  for (const int length : {5, 10}) {
    std::vector<double> rho(100, 10);
    for (std::size_t i = 3; i < rho.size(); i += 10)
      rho[i] = 1e6;
    const Profile kept =
        sampled(profile_of(rho), {.method = SamplingMethod::kPaper, .window = length});
    EXPECT_EQ(kept.points.size(), 100 / length);
  }
}

// Each block of L = 5 points is replaced by its mean. The last block may have fewer points, so the
// ratio is slightly larger than 1 / L. [WLL] table 1 states .2046 and .2012.
TEST(PaperSampling, KeepsAFifthAtFive) {
  std::mt19937_64 random(3);
  std::size_t before = 0, after = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<double> rho(100 + random() % 900);
    for (double& r : rho)
      r = 30 + .03 * std::normal_distribution<double>()(random);
    const Profile profile = profile_of(rho);
    before += rho.size();
    after += sampled(profile, {.method = SamplingMethod::kPaper, .window = 5}).points.size();
  }
  const double ratio = static_cast<double>(after) / static_cast<double>(before);
  EXPECT_GT(ratio, .2);
  EXPECT_LT(ratio, .206);
}

// Returns a flat profile with a narrow groove, 1 mm deep.
std::vector<double> grooved(std::size_t count) {
  std::vector<double> rho(count, 30);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = (static_cast<double>(i) - 200) / 6;
    rho[i] -= std::exp(-x * x);
  }
  return rho;
}

// Returns the largest difference in rho, in mm, between the points of `full` and the polyline
// `kept` at the same height.
double deviation(const Profile& full, const Profile& kept) {
  double largest = 0;
  for (const ProfilePoint& p : full.points) {
    for (std::size_t i = 1; i < kept.points.size(); ++i) {
      const TablePoint &a = kept.points[i - 1].at, &b = kept.points[i].at;
      if (p.at.z > a.z || p.at.z < b.z) continue;
      const double t = (p.at.z - a.z) / (b.z - a.z);
      largest = std::max(largest, std::abs(p.at.rho - a.rho - t * (b.rho - a.rho)));
    }
  }
  return largest;
}

TEST(AdaptiveSampling, SpendsItsPointsOnDetail) {
  const Profile full = profile_of(grooved(400));
  for (const int length : {5, 10, 15, 20}) {
    SCOPED_TRACE(length);
    const Profile kept = sampled(full, {.window = length}),
                  paper = sampled(full, {.method = SamplingMethod::kPaper, .window = length});
    EXPECT_LE(kept.points.size(), 400u / static_cast<std::size_t>(length) + 1);
    EXPECT_LT(deviation(full, kept), .5 * deviation(full, paper));
  }
}

// Returns the rms difference in rho, in mm, between the polyline `kept` and `truth`, over the rows
// of `truth`.
double rms_deviation(const std::vector<double>& truth, const Profile& kept) {
  const Profile full = profile_of(truth);
  double squares = 0;
  std::size_t count = 0;
  for (const ProfilePoint& p : full.points) {
    for (std::size_t i = 1; i < kept.points.size(); ++i) {
      const TablePoint &a = kept.points[i - 1].at, &b = kept.points[i].at;
      if (p.at.z > a.z || p.at.z <= b.z) continue;
      const double t = (p.at.z - a.z) / (b.z - a.z);
      squares += std::pow(p.at.rho - a.rho - t * (b.rho - a.rho), 2), ++count;
    }
  }
  return std::sqrt(squares / static_cast<double>(count));
}

TEST(AdaptiveSampling, IsNoWorseThanPlainAveragingOfNoise) {
  for (const int length : {5, 10, 15, 20}) {
    SCOPED_TRACE(length);
    double adaptive = 0, paper = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      std::mt19937_64 random(seed);
      std::vector<double> rho = grooved(400);
      for (double& r : rho)
        r += .03 * std::normal_distribution<double>()(random);
      const Profile full = profile_of(rho);
      adaptive += rms_deviation(grooved(400), sampled(full, {.window = length, .noise = .03}));
      paper += rms_deviation(grooved(400),
                             sampled(full, {.method = SamplingMethod::kPaper, .window = length}));
    }
    EXPECT_LE(adaptive, paper);
  }
}

TEST(AdaptiveSampling, KeepsTheEndsAndDoesNotCrossThem) {
  std::vector<double> rho(40, 30);
  for (std::size_t i = 20; i < 40; ++i)
    rho[i] = 10;
  Profile full = profile_of(rho);
  full.points[20].flags = kApart;
  const Profile kept = sampled(full, {.window = 20});
  ASSERT_EQ(kept.points.size(), 4);
  EXPECT_THAT(rhos(kept), testing::Pointwise(testing::DoubleNear(1e-9), {30., 30., 10., 10.}));
  EXPECT_EQ(kept.points[1].row, 19);
  EXPECT_EQ(kept.points[2].row, 20);
  EXPECT_EQ(kept.points[2].flags, kApart);
  EXPECT_EQ(kept.points[3].flags, 0);
}

// A polyline through the means of points would lie on the inner side of a bend. Its error would be
// a quarter larger than necessary.
TEST(AdaptiveSampling, LiesInTheMiddleOfABend) {
  std::vector<double> round;
  for (int i = -100; i <= 100; ++i)
    round.push_back(std::sqrt(900 - .01 * i * i));
  const Profile full = profile_of(round);
  const Profile kept = sampled(full, {.window = 20});
  double sum = 0;
  for (std::size_t i = 1; i < kept.points.size(); ++i) {
    const TablePoint &a = kept.points[i - 1].at, &b = kept.points[i].at;
    const double middle = (a.z + b.z) / 2 + 10;
    sum += (a.rho + b.rho) / 2 - std::sqrt(900 - middle * middle);
  }
  const double sagitta = 2. * 2 / (8 * 30);
  EXPECT_LT(std::abs(sum / static_cast<double>(kept.points.size() - 1)), .6 * sagitta);
}

// A flat profile needs few points. The points that it saves must go to a detailed profile.
TEST(AdaptiveSampling, SharesPointsAmongProfiles) {
  std::vector<double> rough(200, 30);
  for (std::size_t i = 0; i < rough.size(); i += 3)
    rough[i] = 31;
  std::vector<Profile> profiles{profile_of(std::vector<double>(200, 30)), profile_of(rough),
                                Profile{13, {}}};
  sample(profiles, {.window = 10});
  EXPECT_LE(profiles[0].points.size(), 14);
  EXPECT_GE(profiles[1].points.size(), 26);
  EXPECT_LE(profiles[0].points.size() + profiles[1].points.size(), 40 + 2);
  EXPECT_TRUE(profiles[2].points.empty());
}

TEST(AnySampling, KeepsRowsAscendingAndCountsBounded) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    Profile full{0, {}};
    int row = 0;
    for (std::size_t i = 0, n = random() % 60; i < n; ++i) {
      row += 1 + static_cast<int>(random() % 3);
      full.points.push_back({{static_cast<double>(random() % 100), 0, -.1 * row},
                             row,
                             static_cast<std::uint8_t>(random() % 16)});
    }
    for (const auto method :
         {SamplingMethod::kEquidistant, SamplingMethod::kPaper, SamplingMethod::kAdaptive}) {
      for (const int length : {1, 2, 5, 20}) {
        const Profile kept = sampled(full, {.method = method, .window = length, .noise = 1});
        EXPECT_LE(kept.points.size(), full.points.size());
        EXPECT_EQ(kept.points.empty(), full.points.empty());
        for (std::size_t i = 1; i < kept.points.size(); ++i)
          EXPECT_LT(kept.points[i - 1].row, kept.points[i].row);
      }
    }
  }
}

}  // namespace
}  // namespace vitrine::acquisition
