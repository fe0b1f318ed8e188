// SPDX-License-Identifier: Apache-2.0
// Merges vertices with equal positions and attributes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

// Compares two vertices by position, then by attributes. Returns a negative number, 0, or a
// positive number. Positions must be finite.
class VertexOrder {
 public:
  VertexOrder(const std::vector<Vec3>& positions, const VertexAttributes& attributes)
      : positions_(positions), attributes_(attributes) {}

  int operator()(std::uint32_t a, std::uint32_t b) const;

  // Sorts `vertices` by value and then by index. Calls visit(vertex, oldest) for each vertex;
  // `oldest` is the vertex with the lowest index among all vertices with the same value.
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
  const VertexAttributes& attributes_;
};

// Merges each vertex v into vertex older[v], unless older[v] is v. older[v] must be at most v.
// Vertex older[v] may itself be merged into another vertex. Changes `older` to hold the new index
// of each old vertex. The remaining vertices keep their order.
void merge_into_older(std::vector<std::uint32_t>& older, std::vector<Vec3>& positions,
                      VertexAttributes& attributes);

// Merges vertices that have exactly the same position and attributes. The remaining vertices are in
// the order of their first appearance. Returns the new index of each old vertex. Positions must be
// finite.
std::vector<std::uint32_t> weld(std::vector<Vec3>& positions, VertexAttributes& attributes);

// Returns the colours of the `count` vertices that remain after merging. A vertex gets the mean
// colour, in linear light, of all vertices merged into it. renamed[v] is the new index of old
// vertex v.
std::vector<Colour> blended(const std::vector<std::uint32_t>& renamed, std::size_t count,
                            const std::vector<Colour>& colours);

}  // namespace vitrine::inline codec
