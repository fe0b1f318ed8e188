// SPDX-License-Identifier: Apache-2.0
// A chart is a connected piece of a mesh that is flattened as a whole. A wedge is a set of face
// corners at one vertex of a chart, connected across edges that are not seams.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/core/vec2.h"

namespace vitrine::inline codec {

// Refers to the positions and faces of a mesh without owning them.
struct MeshView {
  std::span<const Vec3> positions;
  std::span<const Triangle> faces;
};

// Half-edge 3 f + k runs from corner k of face f to the face's next corner. Element [f][k] is the
// opposite half-edge, or the half-edge itself at a boundary or a seam.
using HalfEdges = std::vector<std::array<std::uint32_t, 3>>;

// Finds the opposite half-edge of each half-edge. A face that repeats a vertex has no neighbours.
HalfEdges joined_edges(const MeshView& mesh);

inline std::uint32_t across(const HalfEdges& edges, std::uint32_t half_edge) {
  return edges[half_edge / 3][half_edge % 3];
}
inline std::uint32_t next_half_edge(std::uint32_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
// Turns an edge into a seam.
inline void cut(HalfEdges& edges, std::uint32_t half_edge) {
  const std::uint32_t other = across(edges, half_edge);
  edges[half_edge / 3][half_edge % 3] = half_edge;
  edges[other / 3][other % 3] = other;
}

struct Chart {
  std::vector<std::uint32_t> faces;  // indices of the chart's faces in the mesh
  HalfEdges edges;                   // opposite half-edges; face f is the mesh's face faces[f]
  std::vector<Triangle> wedges;      // for each face, the wedge numbers of its corners
  std::vector<Vec3> positions;       // position of each wedge in space
  std::vector<Vec2> uv;              // position of each wedge in the plane

  std::uint32_t size() const { return static_cast<std::uint32_t>(faces.size()); }
};

// Divides the faces into connected sets of faces with the same label. Returns, for each face, the
// number of its set. Sets are numbered in the order of their first faces.
std::vector<std::uint32_t> connected_sets(const HalfEdges& edges,
                                          std::span<const std::uint32_t> labels);

// Returns the half-edges of each boundary loop. Seams count as boundaries.
std::vector<std::vector<std::uint32_t>> boundary_loops(const HalfEdges& edges);

// Returns one chart for each connected set of faces with the same label, in the order of their
// first faces. An edge between faces of different labels becomes a seam. `faces` holds indices of
// faces of the mesh. `edges` and `labels` have one entry per face in `faces`.
std::vector<Chart> charts_of(const MeshView& mesh, std::span<const std::uint32_t> faces,
                             const HalfEdges& edges, std::span<const std::uint32_t> labels);

// Recomputes the wedges of the chart. Call this after cutting edges of the chart.
void find_wedges(const MeshView& mesh, Chart& chart);

}  // namespace vitrine::inline codec
