// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/face_neighbours.h"

#include <algorithm>
#include <utility>

namespace vitrine {
namespace {

// An edge waits in the bucket of its smaller vertex until the face across comes by.
struct Waiting {
  std::uint32_t other;  // its larger vertex
  std::uint32_t face;
  std::uint32_t edge;
  bool upwards;  // the face runs from the smaller vertex to the larger
};

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
  std::vector<Waiting> waiting(3 * faces.size());
  std::vector<std::array<std::uint32_t, 3>> across(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    across[f] = {3 * f, 3 * f + 1, 3 * f + 2};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
      const Waiting own{high, f, k, faces[f][k] == low};
      Waiting* const bucket = waiting.data() + start[low];
      std::uint32_t& n = size[low];
      Waiting* const twin = std::find_if(bucket, bucket + n, [&own](const Waiting& w) {
        return w.other == own.other && w.upwards != own.upwards;
      });
      if (twin == bucket + n) {
        bucket[n++] = own;
      } else {
        across[f][k] = 3 * twin->face + twin->edge, across[twin->face][twin->edge] = 3 * f + k;
        *twin = bucket[--n];
      }
    }
  }
  return across;
}

}  // namespace vitrine
