// SPDX-License-Identifier: Apache-2.0
// Groups the faces at each edge. An edge may have any number of faces, with any orientations.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine::inline codec {

// One face at an edge. The entry is stored under the edge's smaller vertex. Corner k (0 to 2) of
// face f has the number 3f + k.
struct EdgeSide {
  std::uint32_t high;    // the edge's larger vertex
  std::uint32_t corner;  // number of the face's corner opposite to the edge
};

class EdgeGroups {
 public:
  EdgeGroups(std::size_t vertex_count, std::span<const Triangle> faces);

  // Calls visit(low, sides) for each edge, in ascending order of the edges' vertices. `low` is the
  // edge's smaller vertex. `sides` has one entry per face, in ascending order of faces.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::uint32_t low = 0; low + 1 < begin_.size(); ++low) {
      for (std::size_t i = begin_[low], end; i < begin_[low + 1]; i = end) {
        for (end = i + 1; end < begin_[low + 1] && sides_[end].high == sides_[i].high;)
          ++end;
        visit(low, std::span<const EdgeSide>(sides_).subspan(i, end - i));
      }
    }
  }

 private:
  // Per vertex v: index in sides_ of the first edge whose smaller vertex is v.
  std::vector<std::uint32_t> begin_;
  std::vector<EdgeSide> sides_;
};

// Whether the face of `corner` traverses the edge opposite to `corner` from the edge's smaller
// vertex to its larger vertex.
inline bool runs_upwards(std::span<const Triangle> faces, std::uint32_t corner) {
  const Triangle& face = faces[corner / 3];
  const std::uint32_t k = corner % 3;
  return face[(k + 1) % 3] < face[(k + 2) % 3];
}

inline std::uint32_t apex(std::span<const Triangle> faces, std::uint32_t corner) {
  return faces[corner / 3][corner % 3];
}

}  // namespace vitrine::inline codec
