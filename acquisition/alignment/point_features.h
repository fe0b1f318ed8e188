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

// Returns the feature of each point, from the points within `reach` mm. A point without neighbours
// gets zeros.
std::vector<PointFeature> point_features(const SurfacePoints& points, double reach);

struct FeatureMatch {
  std::uint32_t from = 0, to = 0;  // indices of the two points
};

// Returns the pairs of points of which each has the feature closest to that of the other, in
// ascending order of `from`. O(n m).
std::vector<FeatureMatch> mutual_matches(std::span<const PointFeature> from,
                                         std::span<const PointFeature> to);

}  // namespace vitrine::acquisition
