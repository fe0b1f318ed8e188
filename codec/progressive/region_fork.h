// SPDX-License-Identifier: Apache-2.0
// The fork of the common prefix into regions: behind the splits of the last common level each
// vertex, in the order of its index, says which region it belongs to. The planes of the header
// give the label that v~ nearly always has, because a region is convex.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/core/range_coder.h"
#include "codec/progressive/manifest.h"
#include "codec/progressive/mesh_state.h"

namespace vitrine {

// The leaf of the region tree that holds `p`. A node of k regions gives k / 2 to its first child.
std::uint16_t leaf_of(std::span<const RegionPlane> planes, const Vec3i& p);

// Moves every vertex to its region; indices follow the order of region 0. Then marks borders.
void assign_regions(MeshState& mesh, std::span<const std::uint16_t> label, std::uint32_t regions);

// `truth(v)` is the label of v; read by an encoder only.
template <class Coder, class Truth>
Expected<void> code_fork(MeshState& mesh, Coder& coder, std::span<const RegionPlane> planes,
                         const Truth& truth) {
  const auto regions = static_cast<std::uint32_t>(planes.size() + 1);
  const int bits = std::bit_width(regions - 1);
  AdaptiveBit as_expected{.one = 65000, .seen = 8};
  std::vector<std::uint16_t> label(mesh.vertex_count());
  for (const VertexId v : mesh.members[0]) {
    const std::uint16_t expected = leaf_of(planes, mesh.positions[v]);
    const std::uint16_t told = Coder::kEncodes ? truth(v) : std::uint16_t{0};
    std::uint32_t k = expected;
    if (coder.bit(as_expected, told == expected ? 1 : 0) == 0) k = coder.raw(told, bits);
    if (k >= regions) return fail(ErrorCode::kBadInput, "damaged chunk: impossible region label");
    label[v] = static_cast<std::uint16_t>(k);
  }
  assign_regions(mesh, label, regions);
  return {};
}

}  // namespace vitrine
