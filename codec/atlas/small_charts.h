// SPDX-License-Identifier: Apache-2.0
// Smooths the borders of charts and merges small charts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Gives a face the label of two of its neighbours if these two have the same label.
void smooth_borders(const HalfEdges& edges, std::span<std::uint32_t> labels);

// Merges each connected chart of six faces or fewer with the neighbour along the longest border.
// Returns the new labels; the faces of each label are connected.
std::vector<std::uint32_t> merge_small_charts(const MeshView& mesh, const HalfEdges& edges,
                                              std::span<const std::uint32_t> labels);

}  // namespace vitrine::inline codec
