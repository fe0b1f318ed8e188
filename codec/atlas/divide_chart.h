// SPDX-License-Identifier: Apache-2.0
// Divides a chart that cannot be flattened well.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Each function below returns one label for each face of the chart. charts_of() divides the chart
// by these labels.

// Divides the chart into two halves, which grow from two faces far apart.
std::vector<std::uint32_t> halves(const Chart& chart);

// Separates the given faces, and all faces that touch them, from all other faces. Returns halves()
// if the separated faces are more than half of the chart.
std::vector<std::uint32_t> with_ring_cut_out(const Chart& chart,
                                             std::span<const std::uint32_t> faces);

// Gives each of the given faces a label of its own. All other faces share one label.
std::vector<std::uint32_t> each_cut_out(const Chart& chart, std::span<const std::uint32_t> faces);

}  // namespace vitrine::inline codec
