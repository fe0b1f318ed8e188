// SPDX-License-Identifier: Apache-2.0
#include "codec/atlas/draw_atlas.h"

#include <iterator>
#include <numeric>
#include <optional>

#include "codec/atlas/chart.h"
#include "codec/atlas/cut_handles.h"
#include "codec/atlas/divide_chart.h"
#include "codec/atlas/flatten.h"
#include "codec/atlas/grow_charts.h"
#include "codec/atlas/inspect_chart.h"
#include "codec/atlas/spread_points.h"

namespace vitrine::inline codec {
namespace {

// Each round divides the charts whose flattening failed. From this round on, bad faces are cut out
// without their neighbours.
constexpr int kSingleFaceRound = 8;
// After this number of rounds, each face of a chart that still fails becomes a chart of its own.
constexpr int kRounds = 12;
// Charts with a larger doubled genus are first divided into halves, because the time to cut handles
// grows with their number.
constexpr std::uint32_t kMostDoubledGenus = 64;

std::vector<std::uint32_t> each_alone(const Chart& chart) {
  std::vector<std::uint32_t> labels(chart.faces.size());
  std::iota(labels.begin(), labels.end(), 0u);
  return labels;
}

// Flattens a chart. Returns nullopt on success, or labels that divide the chart on failure.
std::optional<std::vector<std::uint32_t>> try_to_flatten(const MeshView& mesh, Chart& chart,
                                                         int round) {
  if (doubled_genus(chart) > kMostDoubledGenus) return halves(chart);
  if (!cut_handles(mesh, chart)) return std::vector<std::uint32_t>(chart.faces.size(), 0);
  if (boundary_loops(chart.edges).empty()) return halves(chart);
  flatten(chart);
  if (chart.size() == 1) return std::nullopt;
  const ChartFaults faults = inspect(chart);
  if (faults.none()) return std::nullopt;
  if (round > kRounds) return each_alone(chart);
  if (faults.overlaps) return halves(chart);
  if (round >= kSingleFaceRound) return each_cut_out(chart, faults.bad_faces);
  return with_ring_cut_out(chart, faults.bad_faces);
}

void append(Atlas& atlas, const Chart& chart) {
  const auto first = static_cast<std::uint32_t>(atlas.uv.size());
  for (const Vec2& uv : chart.uv)
    atlas.uv.push_back({uv.x, uv.y});
  for (std::uint32_t f = 0; f < chart.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k)
      atlas.wedges[chart.faces[f]][k] = first + chart.wedges[f][k];
  }
  atlas.chart.resize(atlas.uv.size(), atlas.charts++);
}

std::vector<Chart> first_charts(const MeshView& mesh) {
  const HalfEdges edges = joined_edges(mesh);
  std::vector<std::uint32_t> all(mesh.faces.size());
  std::iota(all.begin(), all.end(), 0u);
  return charts_of(mesh, all, edges, grow_charts(mesh, edges));
}

}  // namespace

Atlas draw_atlas(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  const std::vector<Vec3> spread = spread_points(positions, faces);
  const MeshView mesh{spread, faces};
  Atlas atlas;
  atlas.wedges.resize(faces.size());
  std::vector<Chart> charts = first_charts(mesh);
  for (int round = 1; !charts.empty(); ++round) {
    std::vector<Chart> next;
    for (Chart& chart : charts) {
      const auto labels = try_to_flatten(mesh, chart, round);
      if (!labels) {
        append(atlas, chart);
        continue;
      }
      std::vector<Chart> parts = charts_of(mesh, chart.faces, chart.edges, *labels);
      std::move(parts.begin(), parts.end(), std::back_inserter(next));
    }
    charts = std::move(next);
  }
  return atlas;
}

}  // namespace vitrine::inline codec
