// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/pack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace vitrine::test {
namespace {

using Point = std::array<double, 2>;

// Random numbers in [0, 1). They are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double next() { return static_cast<double>(engine_() >> 11) / 9007199254740992.0; }

 private:
  std::mt19937_64 engine_;
};

// Returns a fan of triangles with a ragged outline, like a texture chart of a scan.
ChartTriangles blob(Random& random, double size) {
  constexpr int kCorners = 24;
  const double turn = 6.283185307179586 / kCorners;
  const Point centre{random.next() * 100, random.next() * 100};
  const double width = size * (0.3 + random.next());
  std::array<Point, kCorners> rim;
  for (int i = 0; i < kCorners; ++i) {
    const double r = size * (0.7 + 0.3 * random.next());
    rim[i] = {centre[0] + width / size * r * std::cos(i * turn),
              centre[1] + r * std::sin(i * turn)};
  }
  ChartTriangles chart;
  for (int i = 0; i < kCorners; ++i)
    chart.push_back({centre, rim[i], rim[(i + 1) % kCorners]});
  return chart;
}

std::vector<ChartTriangles> blobs(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<ChartTriangles> charts;
  for (int i = 0; i < count; ++i)
    charts.push_back(blob(random, 1 + 3 * random.next() * random.next()));
  return charts;
}

Point moved(const Point& p, const Packing& packing, std::size_t chart) {
  return {p[0] * packing.scale + packing.offset[chart][0],
          p[1] * packing.scale + packing.offset[chart][1]};
}

double covered(const std::vector<ChartTriangles>& charts, const Packing& packing) {
  double sum = 0;
  for (const ChartTriangles& chart : charts) {
    for (const auto& [a, b, c] : chart)
      sum += std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }
  return sum * packing.scale * packing.scale;
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  const double along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (square > 0 ? square : 1);
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

// Returns the least distance between the outlines of two packed fans. The outline of a fan consists
// of the edges from corner 1 to corner 2 of its triangles.
double distance(const ChartTriangles& a, std::size_t i, const ChartTriangles& b, std::size_t j,
                const Packing& packing) {
  double least = 1e300;
  for (const auto& s : a) {
    const Point s1 = moved(s[1], packing, i), s2 = moved(s[2], packing, i);
    for (const auto& t : b) {
      const Point t1 = moved(t[1], packing, j), t2 = moved(t[2], packing, j);
      least = std::min({least, distance_to_segment(s1, t1, t2), distance_to_segment(s2, t1, t2),
                        distance_to_segment(t1, s1, s2), distance_to_segment(t2, s1, s2)});
    }
  }
  return least;
}

void expect_in_square(const std::vector<ChartTriangles>& charts, const Packing& packing) {
  ASSERT_EQ(packing.offset.size(), charts.size());
  for (std::size_t i = 0; i < charts.size(); ++i) {
    for (const auto& triangle : charts[i]) {
      for (const Point& p : triangle) {
        const Point q = moved(p, packing, i);
        EXPECT_GE(std::min(q[0], q[1]), -1e-9);
        EXPECT_LE(std::max(q[0], q[1]), 1 + 1e-9);
      }
    }
  }
}

TEST(Pack, ChartsKeepTheGutterBetweenThem) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const std::vector<ChartTriangles> charts = blobs(seed, 40);
    const Packing packing = pack(charts, 1.0 / 256);
    expect_in_square(charts, packing);
    for (std::size_t i = 0; i < charts.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_GE(distance(charts[i], i, charts[j], j, packing), 1.0 / 256 - 1e-9)
            << "seed " << seed << ", charts " << j << " and " << i;
      }
    }
  }
}

TEST(Pack, FortyChartsCoverMostOfTheSquare) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const std::vector<ChartTriangles> charts = blobs(seed, 40);
    sum += covered(charts, pack(charts)) / 3;
  }
  RecordProperty("covered", std::to_string(sum));
  EXPECT_GT(sum, 0.6);
}

TEST(Pack, AChartMayLieInTheHoleOfAnother) {
  ChartTriangles ring;
  const std::array<Point, 4> outer{Point{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const std::array<Point, 4> inner{Point{1, 1}, {9, 1}, {9, 9}, {1, 9}};
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    ring.push_back({outer[i], outer[j], inner[j]});
    ring.push_back({outer[i], inner[j], inner[i]});
  }
  const ChartTriangles core{{Point{50, 50}, {57, 50}, {57, 57}},
                            {Point{50, 50}, {57, 57}, {50, 57}}};
  const Packing packing = pack(std::vector{ring, core});
  EXPECT_GT(packing.scale, 0.095);  // the ring alone would have the scale 0.1
}

TEST(Pack, ManyMoreChartsThanGuttersAllowStillFindPlaces) {
  const std::vector<ChartTriangles> charts = blobs(7, 200);
  expect_in_square(charts, pack(charts, 1.0 / 8));
}

TEST(Pack, ChartsWithoutTrianglesOrAreaAreNoFault) {
  const std::vector<ChartTriangles> charts{
      {}, {{Point{1, 1}, {1, 1}, {1, 1}}}, {{Point{0, 0}, {5, 5}, {10, 10}}}};
  expect_in_square(charts, pack(charts));
  expect_in_square({}, pack({}));
}

}  // namespace
}  // namespace vitrine::test
