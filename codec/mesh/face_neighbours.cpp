// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/face_neighbours.h"

#include <algorithm>
#include <utility>

namespace vitrine::inline codec {
namespace {

// The start and the end of a half-edge.
struct EdgeEnds {
  std::uint32_t from, to;
};

EdgeEnds ends(std::span<const Triangle> faces, std::uint32_t half_edge) {
  const Triangle& f = faces[half_edge / 3];
  return {f[half_edge % 3], f[(half_edge + 1) % 3]};
}

std::vector<std::uint32_t> bucket_starts(std::span<const Triangle> faces,
                                         std::size_t vertex_count) {
  std::vector<std::uint32_t> start(vertex_count + 1, 0);
  for (const Triangle& f : faces) {
    for (std::size_t k = 0; k < 3; ++k)
      ++start[std::min(f[k], f[(k + 1) % 3])];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& s : start)
    sum += std::exchange(s, sum);
  return start;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> face_neighbours(std::span<const Triangle> faces,
                                                          std::size_t vertex_count) {
  const std::vector<std::uint32_t> start = bucket_starts(faces, vertex_count);
  std::vector<std::uint32_t> size(vertex_count, 0);
  // Holds one list of half-edges per vertex v. v is the smaller vertex of these half-edges, and
  // their opposite half-edges have not been found yet.
  std::vector<std::uint32_t> waiting(3 * faces.size());
  std::vector<std::array<std::uint32_t, 3>> across(faces.size());
  for (std::uint32_t h = 0; h < 3 * faces.size(); ++h) {
    const EdgeEnds own = ends(faces, h);
    across[h / 3][h % 3] = h;
    std::uint32_t* const bucket = waiting.data() + start[std::min(own.from, own.to)];
    std::uint32_t& n = size[std::min(own.from, own.to)];
    std::uint32_t* const twin = std::find_if(bucket, bucket + n, [&](std::uint32_t other) {
      const EdgeEnds e = ends(faces, other);
      return e.from == own.to && e.to == own.from;
    });
    if (twin == bucket + n) {
      bucket[n++] = h;
    } else {
      across[h / 3][h % 3] = *twin, across[*twin / 3][*twin % 3] = h;
      *twin = bucket[--n];
    }
  }
  return across;
}

}  // namespace vitrine::inline codec
