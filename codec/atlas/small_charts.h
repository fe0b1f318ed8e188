// SPDX-License-Identifier: Apache-2.0
// Smooths the borders of charts and merges small charts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Changes the label of each face that has two neighbours with the same label: the face gets their
// label.
void smooth_borders(const HalfEdges& edges, std::span<std::uint32_t> labels);

// Merges each connected chart of at most six faces with the chart with which it shares the longest
// border. Returns the new labels. The faces of each label are connected.
std::vector<std::uint32_t> merge_small_charts(const MeshView& mesh, const HalfEdges& edges,
                                              std::span<const std::uint32_t> labels);

}  // namespace vitrine::inline codec
