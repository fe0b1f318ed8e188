// SPDX-License-Identifier: Apache-2.0
// Connectivity of the base mesh while it is read: a corner table with open boundaries. Corners are
// numbered as in codec/mesh/connectivity.h: face f has the corners 3f to 3f + 2. Internal to
// codec/base.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/mesh/connectivity.h"

namespace vitrine::inline codec {

struct CornerTable {
  std::vector<VertexId> vertex;  // per corner: its vertex
  std::vector<Corner> opposite;  // per corner: the corner across its opposite edge, or kNoCorner
  // per vertex: one of its corners; for a boundary vertex, its last corner counter-clockwise
  std::vector<Corner> leftmost;

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(leftmost.size()); }
  std::uint32_t face_count() const { return static_cast<std::uint32_t>(vertex.size() / 3); }

  // Return the next corner at the same vertex: swing_left() counter-clockwise, swing_right()
  // clockwise. Return kNoCorner at the boundary.
  Corner swing_left(Corner c) const {
    const Corner across = opposite[next(c)];
    return across == kNoCorner ? kNoCorner : next(across);
  }
  Corner swing_right(Corner c) const {
    const Corner across = opposite[prev(c)];
    return across == kNoCorner ? kNoCorner : prev(across);
  }
};

}  // namespace vitrine::inline codec
