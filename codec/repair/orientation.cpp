// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/manifold.h"

#include <utility>
#include <vector>

#include "codec/repair/edge_pairs.h"

namespace vitrine::inline codec {
namespace {

bool agree(std::span<const Triangle> faces, std::uint32_t a, std::uint32_t b) {
  return runs_upwards(faces, a) != runs_upwards(faces, b);
}

// Returns, for each corner, the corner across the opposite edge, or kNoPartner. Only edges with
// exactly two faces count. The two faces may have any orientation but must have different third
// vertices.
std::vector<std::uint32_t> neighbours(std::span<const Triangle> faces, const EdgeGroups& groups) {
  std::vector<std::uint32_t> across(3 * faces.size(), kNoPartner);
  groups.for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
    if (sides.size() != 2 || apex(faces, sides[0].corner) == apex(faces, sides[1].corner)) return;
    across[sides[0].corner] = sides[1].corner;
    across[sides[1].corner] = sides[0].corner;
  });
  return across;
}

bool all_agree(std::span<const Triangle> faces, const EdgeGroups& groups) {
  bool result = true;
  groups.for_each([&](std::uint32_t, std::span<const EdgeSide> sides) {
    if (sides.size() == 2 && !agree(faces, sides[0].corner, sides[1].corner)) result = false;
  });
  return result;
}

enum : std::uint8_t { kKeep, kReverse, kUnknown };

// Finds the patch that contains the face patch[0], breadth-first. Appends each face reached to
// `patch`. Sets the face's `turn` so that the face gets the same final orientation as patch[0].
void spread(std::span<const Triangle> faces, std::span<const std::uint32_t> across,
            std::vector<std::uint8_t>& turn, std::vector<std::uint32_t>& patch) {
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const std::uint32_t f = patch[i];
    for (std::uint32_t c = 3 * f; c < 3 * f + 3; ++c) {
      const std::uint32_t other = across[c];
      if (other == kNoPartner || turn[other / 3] != kUnknown) continue;
      turn[other / 3] = turn[f] ^ static_cast<std::uint8_t>(!agree(faces, c, other));
      patch.push_back(other / 3);
    }
  }
}

}  // namespace

std::vector<std::uint32_t> orient_patches(std::span<Triangle> faces, const EdgeGroups& groups) {
  std::vector<std::uint32_t> reversed_faces;
  if (all_agree(faces, groups)) return reversed_faces;
  const std::vector<std::uint32_t> across = neighbours(faces, groups);
  std::vector<std::uint8_t> turn(faces.size(), kUnknown);
  std::vector<std::uint32_t> patch;
  for (std::uint32_t seed = 0; seed < faces.size(); ++seed) {
    if (turn[seed] != kUnknown) continue;
    patch.assign(1, seed);
    turn[seed] = kKeep;
    spread(faces, across, turn, patch);
    std::size_t reversed = 0;
    for (const std::uint32_t f : patch)
      reversed += turn[f] == kReverse;
    if (2 * reversed <= patch.size()) continue;
    for (const std::uint32_t f : patch)
      turn[f] ^= 1;
  }
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (turn[f] != kReverse) continue;
    std::swap(faces[f][1], faces[f][2]);
    reversed_faces.push_back(f);
  }
  return reversed_faces;
}

}  // namespace vitrine::inline codec
