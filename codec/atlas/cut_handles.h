// SPDX-License-Identifier: Apache-2.0
// Cuts a chart along its handles, so that the chart can be flattened.
#pragma once

#include "codec/atlas/chart.h"

namespace vitrine::inline codec {

// Returns twice the genus of the chart, by Euler's formula. A sphere has genus 0, with or without
// holes.
std::uint32_t doubled_genus(const Chart& chart);

// Cuts the chart along its shortest loops that do not divide it, until the chart has no handles.
// Uses the tree-cotree decomposition of [EW05] from up to 60 roots. Returns false as soon as the
// seams divide the chart, which can happen if a loop touches a hole twice. Handles may then remain.
bool cut_handles(const MeshView& mesh, Chart& chart);

}  // namespace vitrine::inline codec
