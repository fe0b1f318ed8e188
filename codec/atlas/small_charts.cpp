// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/small_charts.h"

#include <algorithm>
#include <optional>

namespace vitrine::inline codec {
namespace {

constexpr std::size_t kSmall = 6;
constexpr int kSmoothingPasses = 3;

double edge_length(const MeshView& mesh, std::uint32_t h) {
  const Triangle& f = mesh.faces[h / 3];
  return length(mesh.positions[f[next_half_edge(h) % 3]] - mesh.positions[f[h % 3]]);
}

// Returns the label of the chart that shares the longest border with a set of faces. Returns
// nullopt if the set has no neighbour.
std::optional<std::uint32_t> closest_neighbour(const MeshView& mesh, const HalfEdges& edges,
                                               std::span<const std::uint32_t> labels,
                                               std::span<const std::uint32_t> faces) {
  struct Border {
    std::uint32_t label;
    double length;
  };
  std::vector<Border> borders;
  for (const std::uint32_t f : faces) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t label = labels[edges[f][k] / 3];
      if (label == labels[f]) continue;
      auto border = std::find_if(borders.begin(), borders.end(),
                                 [&](const Border& b) { return b.label == label; });
      if (border == borders.end()) border = borders.insert(border, {label, 0});
      border->length += edge_length(mesh, 3 * f + k);
    }
  }
  const auto longest =
      std::max_element(borders.begin(), borders.end(),
                       [](const Border& a, const Border& b) { return a.length < b.length; });
  if (longest == borders.end()) return std::nullopt;
  return longest->label;
}

}  // namespace

void smooth_borders(const HalfEdges& edges, std::span<std::uint32_t> labels) {
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    for (std::uint32_t f = 0; f < edges.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = labels[edges[f][k] / 3], b = labels[edges[f][(k + 1) % 3] / 3];
        if (a == b && a != labels[f]) labels[f] = a;
      }
    }
  }
}

std::vector<std::uint32_t> merge_small_charts(const MeshView& mesh, const HalfEdges& edges,
                                              std::span<const std::uint32_t> labels) {
  std::vector<std::uint32_t> label = connected_sets(edges, labels);
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t f = 0; f < label.size(); ++f) {
    if (label[f] == members.size()) members.emplace_back();
    members[label[f]].push_back(f);
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::vector<std::uint32_t>& small : members) {
      if (small.empty() || small.size() > kSmall) continue;
      const auto into = closest_neighbour(mesh, edges, label, small);
      if (!into) continue;
      for (const std::uint32_t f : small)
        label[f] = *into;
      members[*into].insert(members[*into].end(), small.begin(), small.end());
      small.clear();
      changed = true;
    }
  }
  return label;
}

}  // namespace vitrine::inline codec
