// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"

namespace vitrine {

// Three-way order of two vertices: by position, then by colour (`colours` may be empty). The
// positions must be finite.
class VertexOrder {
 public:
  VertexOrder(const std::vector<Vec3>& positions, const std::vector<Colour>& colours)
      : positions_(positions), colours_(colours) {}

  int operator()(std::uint32_t a, std::uint32_t b) const;

  // Sorts `vertices`, equal ones by number, and calls visit(vertex, oldest equal one) for each.
  template <class Visit>
  void for_each_oldest(std::vector<std::uint32_t> vertices, Visit visit) const {
    std::sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
      const int by_value = (*this)(a, b);
      return by_value != 0 ? by_value < 0 : a < b;
    });
    std::uint32_t oldest = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (i == 0 || (*this)(oldest, vertices[i]) != 0) oldest = vertices[i];
      visit(vertices[i], oldest);
    }
  }

 private:
  const std::vector<Vec3>& positions_;
  const std::vector<Colour>& colours_;
};

// Removes each vertex v whose older[v] is not v: it becomes vertex older[v] < v, which may itself
// become an older one. Turns `older` into the new index of each old vertex; those that remain keep
// their order.
void merge_into_older(std::vector<std::uint32_t>& older, std::vector<Vec3>& positions,
                      std::vector<Colour>& colours);

// Merges vertices of exactly the same position and colour (`colours` may be empty); those that
// remain keep the order of their first appearance. Returns the new index of each old vertex. The
// positions must be finite.
std::vector<std::uint32_t> weld(std::vector<Vec3>& positions, std::vector<Colour>& colours);

// The mean in linear light of the colours of the vertices that become one of `count`.
std::vector<Colour> blended(const std::vector<std::uint32_t>& renamed, std::size_t count,
                            const std::vector<Colour>& colours);

}  // namespace vitrine
