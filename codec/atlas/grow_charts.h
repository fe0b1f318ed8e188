// SPDX-License-Identifier: Apache-2.0
// Divides the faces of a mesh into compact charts whose normals vary little.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Returns a label for each face. Grows about 40 charts from seed faces by Dijkstra's algorithm,
// moves each seed to the middle of its chart, and repeats both steps (Lloyd's algorithm on faces,
// as in [SWG03]). Each component has at least one chart. Charts with few faces are merged with a
// neighbour chart, if there is one.
std::vector<std::uint32_t> grow_charts(const MeshView& mesh, const HalfEdges& edges);

}  // namespace vitrine::inline codec
