// SPDX-License-Identifier: Apache-2.0
// Describes the shape of a surface around each of its points by numbers that do not depend on the
// object's pose: fast point feature histograms [RBB09].
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "acquisition/alignment/surface_points.h"

namespace vitrine::acquisition {

inline constexpr std::size_t kFeatureSize = 33;
using PointFeature = std::array<float, kFeatureSize>;  // three histograms of 11 bins, in percent

// Returns the feature of each point, computed from the points within `reach` mm. All components are
// 0 for a point without neighbours.
std::vector<PointFeature> point_features(const SurfacePoints& points, double reach);

struct FeatureMatch {
  std::uint32_t from = 0, to = 0;  // indices of the two points
};

// Returns the pairs of points whose features are mutually closest, in ascending order of `from`.
// Takes time proportional to the product of the two numbers of points.
std::vector<FeatureMatch> mutual_matches(std::span<const PointFeature> from,
                                         std::span<const PointFeature> to);

}  // namespace vitrine::acquisition
