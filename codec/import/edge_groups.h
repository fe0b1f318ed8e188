// SPDX-License-Identifier: Apache-2.0
// All faces round each edge, whatever their number and direction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// The edge opposite to corner 3f + k of face f, seen from its end of smaller index.
struct EdgeSide {
  std::uint32_t high;    // the end of larger index
  std::uint32_t corner;  // 3f + k
};

class EdgeGroups {
 public:
  EdgeGroups(std::size_t vertex_count, std::span<const Triangle> faces);

  // Calls visit(low, sides) for each edge, in ascending order of its ends; `sides` has one entry
  // for each face, in ascending order.
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
  std::vector<std::uint32_t> begin_;  // per low vertex, into sides_
  std::vector<EdgeSide> sides_;
};

// Whether the face of `corner` runs along the edge opposite to it from low to high.
inline bool runs_upwards(std::span<const Triangle> faces, std::uint32_t corner) {
  const Triangle& face = faces[corner / 3];
  const std::uint32_t k = corner % 3;
  return face[(k + 1) % 3] < face[(k + 2) % 3];
}

inline std::uint32_t apex(std::span<const Triangle> faces, std::uint32_t corner) {
  return faces[corner / 3][corner % 3];
}

}  // namespace vitrine
