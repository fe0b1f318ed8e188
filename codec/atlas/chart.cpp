// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/chart.h"

#include "codec/mesh/disjoint_sets.h"
#include "codec/mesh/face_neighbours.h"

namespace vitrine::inline codec {
namespace {

constexpr std::uint32_t kNoIndex = 0xFFFF'FFFFu;

bool repeats_vertex(const Triangle& f) {
  return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
}

// Returns the boundary half-edge that starts where the boundary half-edge `h` ends.
std::uint32_t next_on_boundary(const HalfEdges& edges, std::uint32_t h) {
  h = next_half_edge(h);
  while (across(edges, h) != h)
    h = next_half_edge(across(edges, h));
  return h;
}

}  // namespace

std::vector<std::uint32_t> connected_sets(const HalfEdges& edges,
                                          std::span<const std::uint32_t> labels) {
  std::vector<std::uint32_t> set(edges.size(), kNoIndex), open;
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < edges.size(); ++first) {
    if (set[first] != kNoIndex) continue;
    set[first] = count;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t f = open.back();
      open.pop_back();
      for (const std::uint32_t other : edges[f]) {
        const std::uint32_t g = other / 3;
        if (set[g] != kNoIndex || labels[g] != labels[f]) continue;
        set[g] = count;
        open.push_back(g);
      }
    }
    ++count;
  }
  return set;
}

HalfEdges joined_edges(const MeshView& mesh) {
  HalfEdges edges = face_neighbours(mesh.faces, mesh.positions.size());
  for (std::uint32_t f = 0; f < edges.size(); ++f) {
    if (!repeats_vertex(mesh.faces[f])) continue;
    for (std::uint32_t k = 0; k < 3; ++k)
      cut(edges, 3 * f + k);
  }
  return edges;
}

std::vector<std::vector<std::uint32_t>> boundary_loops(const HalfEdges& edges) {
  std::vector<std::uint8_t> seen(3 * edges.size(), 0);
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::uint32_t first = 0; first < seen.size(); ++first) {
    if (across(edges, first) != first || seen[first]) continue;
    loops.emplace_back();
    for (std::uint32_t h = first; !seen[h]; h = next_on_boundary(edges, h)) {
      seen[h] = 1;
      loops.back().push_back(h);
    }
  }
  return loops;
}

void find_wedges(const MeshView& mesh, Chart& chart) {
  DisjointSets corners(3 * chart.faces.size());
  for (std::uint32_t h = 0; h < 3 * chart.size(); ++h) {
    const std::uint32_t other = across(chart.edges, h);
    if (other != h) corners.join(h, next_half_edge(other));
  }
  std::vector<std::uint32_t> wedge(3 * chart.faces.size());
  chart.wedges.resize(chart.faces.size());
  chart.positions.clear();
  for (std::uint32_t c = 0; c < 3 * chart.size(); ++c) {
    const std::uint32_t first = corners.find(c);
    if (first == c) {
      wedge[c] = static_cast<std::uint32_t>(chart.positions.size());
      chart.positions.push_back(mesh.positions[mesh.faces[chart.faces[c / 3]][c % 3]]);
    }
    chart.wedges[c / 3][c % 3] = wedge[first];
  }
}

std::vector<Chart> charts_of(const MeshView& mesh, std::span<const std::uint32_t> faces,
                             const HalfEdges& edges, std::span<const std::uint32_t> labels) {
  const std::vector<std::uint32_t> set = connected_sets(edges, labels);
  std::vector<Chart> charts;
  std::vector<std::uint32_t> place(faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    if (set[f] == charts.size()) charts.emplace_back();
    place[f] = charts[set[f]].size();
    charts[set[f]].faces.push_back(faces[f]);
  }
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    std::array<std::uint32_t, 3> local;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t other = edges[f][k];
      const bool is_inner = set[other / 3] == set[f] && other != 3 * f + k;
      local[k] = is_inner ? 3 * place[other / 3] + other % 3 : 3 * place[f] + k;
    }
    charts[set[f]].edges.push_back(local);
  }
  for (Chart& chart : charts)
    find_wedges(mesh, chart);
  return charts;
}

}  // namespace vitrine::inline codec
