// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/edge_pairs.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {
namespace {

// A face at an edge, and its angle around the edge.
struct Leaf {
  double angle;
  bool is_upwards;
  std::uint32_t apex;
  std::uint32_t corner;
};

// Computes the angle of each face around the edge from `low` to its larger vertex. Angles increase
// counter-clockwise as seen from the larger vertex. The direction of angle 0 is arbitrary.
std::vector<Leaf> leaves_of(std::span<const Vec3> positions, std::span<const Triangle> faces,
                            std::uint32_t low, std::span<const EdgeSide> sides) {
  const Vec3 axis = positions[sides[0].high] - positions[low];
  const Vec3 u = cross(axis, std::abs(axis.x) <= std::abs(axis.y) ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  const Vec3 v = cross(axis * (1 / std::max(length(axis), 1e-300)), u);
  std::vector<Leaf> leaves;
  for (const EdgeSide& side : sides) {
    const std::uint32_t tip = apex(faces, side.corner);
    const Vec3 d = positions[tip] - positions[low];
    leaves.push_back(
        {std::atan2(dot(d, v), dot(d, u)), runs_upwards(faces, side.corner), tip, side.corner});
  }
  return leaves;
}

void pair(std::vector<std::uint32_t>& across, std::uint32_t a, std::uint32_t b) {
  across[a] = b;
  across[b] = a;
}

// Pairs the faces around an edge like brackets. A face runs upwards if it traverses the edge from
// the smaller to the larger vertex. The solid lies clockwise of such a face. Each upward face
// therefore opens a bracket, and the next downward face in clockwise order closes it. The loop goes
// around twice, because a bracket may extend past the last face. At equal angles, downward faces
// come first, so that the two sides of a thin sheet are not paired.
void pair_fan(std::vector<Leaf> leaves, std::vector<std::uint32_t>& across) {
  std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) {
    if (a.angle != b.angle) return a.angle > b.angle;
    return a.is_upwards != b.is_upwards ? b.is_upwards : a.corner < b.corner;
  });
  std::vector<const Leaf*> open;
  for (std::size_t i = 0; i < 2 * leaves.size(); ++i) {
    const Leaf& leaf = leaves[i % leaves.size()];
    if (across[leaf.corner] != kNoPartner) continue;
    if (leaf.is_upwards) {
      if (i < leaves.size()) open.push_back(&leaf);
    } else if (!open.empty() && open.back()->apex != leaf.apex) {
      pair(across, open.back()->corner, leaf.corner);
      open.pop_back();
    }
  }
}

}  // namespace

std::vector<std::uint32_t> pair_faces(std::span<const Vec3> positions,
                                      std::span<const Triangle> faces, const EdgeGroups& groups) {
  std::vector<std::uint32_t> across(3 * faces.size(), kNoPartner);
  groups.for_each([&](std::uint32_t low, std::span<const EdgeSide> sides) {
    if (sides.size() > 2) return pair_fan(leaves_of(positions, faces, low, sides), across);
    if (sides.size() < 2) return;
    const std::uint32_t a = sides[0].corner, b = sides[1].corner;
    if (runs_upwards(faces, a) == runs_upwards(faces, b)) return;
    if (apex(faces, a) != apex(faces, b)) pair(across, a, b);
  });
  return across;
}

}  // namespace vitrine::inline codec
