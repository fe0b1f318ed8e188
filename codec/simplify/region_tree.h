// SPDX-License-Identifier: Apache-2.0
// Labels the vertices of the fine mesh with the regions of a kd-tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/progressive/manifest.h"

namespace vitrine {

struct RegionTree {
  std::vector<RegionPlane> planes;    // regions - 1, in pre-order
  std::vector<std::uint16_t> region;  // per position
};

// A node with k > 1 regions gives k / 2 of them to its first child and the rest to the second, and
// splits its vertices in that proportion along the longest side of their box. Regions are numbered
// from the first leaf to the last. A region is empty only where vertices coincide.
RegionTree build_region_tree(std::span<const Vec3i> positions, std::uint32_t regions);

}  // namespace vitrine
