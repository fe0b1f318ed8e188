// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/point_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kBins = 11;
constexpr float kPercent = 100;
constexpr std::size_t kBlock = 16;  // number of features compared at once

std::size_t bin_of(double value, double low, double high) {
  const double part = (value - low) / (high - low) * kBins;
  return static_cast<std::size_t>(std::clamp(part, 0., kBins - 1.));
}

// Computes the three angles of a pair of points ([RBB09]) and counts them in the first point's
// histograms.
void count_pair(PointFeature& counts, Vec3 d, Vec3 normal, Vec3 other) {
  const double size = length(d);
  if (!(size > 0)) return;
  d = d * (1 / size);
  // The pair's frame is at the point whose normal has the smaller angle to the line between the
  // points.
  if (std::abs(dot(normal, d)) < std::abs(dot(other, d))) {
    std::swap(normal, other);
    d = d * -1;
  }
  const Vec3 across = cross(d, normal);
  const double width = length(across);
  if (!(width > 0)) return;
  const Vec3 v = across * (1 / width), w = cross(normal, v);
  const double angle = std::atan2(dot(w, other), dot(normal, other));
  ++counts[bin_of(angle, -std::numbers::pi, std::numbers::pi)];
  ++counts[kBins + bin_of(dot(v, other), -1, 1)];
  ++counts[2 * kBins + bin_of(dot(normal, d), -1, 1)];
}

// Scales each of the three histograms to a sum of 100.
void normalise(PointFeature& feature) {
  for (std::size_t k = 0; k < kFeatureSize; k += kBins) {
    float sum = 0;
    for (std::size_t i = 0; i < kBins; ++i)
      sum += feature[k + i];
    for (std::size_t i = 0; i < kBins && sum > 0; ++i)
      feature[k + i] *= kPercent / sum;
  }
}

// kBlock features, stored component by component, so that one SIMD instruction compares several
// features.
using Block = std::array<std::array<float, kBlock>, kFeatureSize>;

// Divides the features into blocks. Fills the last block with dummy features that are far from all
// real features.
std::vector<Block> blocks_of(std::span<const PointFeature> features) {
  std::vector<Block> blocks((features.size() + kBlock - 1) / kBlock);
  for (std::size_t i = 0; i < blocks.size() * kBlock; ++i) {
    for (std::size_t k = 0; k < kFeatureSize; ++k)
      blocks[i / kBlock][k][i % kBlock] = i < features.size() ? features[i][k] : 1e6F;
  }
  return blocks;
}

std::array<float, kBlock> squared_distances(const PointFeature& feature, const Block& block) {
  std::array<float, kBlock> sums{};
  for (std::size_t k = 0; k < kFeatureSize; ++k) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float d = feature[k] - block[k][i];
      sums[i] += d * d;
    }
  }
  return sums;
}

struct Closest {
  float squared = std::numeric_limits<float>::infinity();
  std::uint32_t point = 0;
  void see(float other, std::uint32_t of) {
    if (other < squared) squared = other, point = of;
  }
};

}  // namespace

std::vector<PointFeature> point_features(const SurfacePoints& points, double reach) {
  const PointGrid grid(points.at, reach);
  std::vector<PointFeature> simple(points.size(), PointFeature{});
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    grid.near(points.at[i], [&](std::uint32_t k) {
      if (k != i)
        count_pair(simple[i], points.at[k] - points.at[i], points.normals[i], points.normals[k]);
    });
    normalise(simple[i]);
  }
  // Adds the features of the neighbours, each weighted by the inverse of its squared distance.
  std::vector<PointFeature> features = simple;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    PointFeature sum{};
    grid.near(points.at[i], [&](std::uint32_t k) {
      const Vec3 d = points.at[k] - points.at[i];
      if (k == i || !(dot(d, d) > 0)) return;
      for (std::size_t b = 0; b < kFeatureSize; ++b)
        sum[b] += simple[k][b] / static_cast<float>(dot(d, d));
    });
    normalise(sum);
    for (std::size_t b = 0; b < kFeatureSize; ++b)
      features[i][b] += sum[b];
  }
  return features;
}

std::vector<FeatureMatch> mutual_matches(std::span<const PointFeature> from,
                                         std::span<const PointFeature> to) {
  const std::vector<Block> blocks = blocks_of(to);
  std::vector<Closest> of_from(from.size()), of_to(blocks.size() * kBlock);
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    for (std::uint32_t b = 0; b < blocks.size(); ++b) {
      const auto squared = squared_distances(from[i], blocks[b]);
      for (std::uint32_t k = 0; k < kBlock; ++k) {
        of_from[i].see(squared[k], static_cast<std::uint32_t>(b * kBlock + k));
        of_to[b * kBlock + k].see(squared[k], i);
      }
    }
  }
  std::vector<FeatureMatch> matches;
  for (std::uint32_t i = 0; i < from.size(); ++i) {
    const std::uint32_t other = of_from[i].point;
    if (other < to.size() && of_to[other].point == i) matches.push_back({i, other});
  }
  return matches;
}

}  // namespace vitrine::acquisition
