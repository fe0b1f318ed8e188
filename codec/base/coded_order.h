// SPDX-License-Identifier: Apache-2.0
// The order in which Draco codes the values of an attribute. Two kinds of walk over the faces
// define two orders: the order in which the walk reaches the vertices. Internal to codec/base.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/base/corner_table.h"

namespace vitrine::inline codec {

struct CodedOrder {
  // per coded value: the corner at which the walk reached its vertex
  std::vector<Corner> corner;
  std::vector<std::uint32_t> rank;  // per vertex: the index of its value in coded order
};

// Depth-first walk: proceeds from face to face as far as possible, then returns to the last face
// that has another unvisited neighbour.
CodedOrder depth_first_order(const CornerTable& table);

// Walk that prefers faces whose three vertices are known, then faces whose unknown vertex is next
// to several visited faces, because several predictions can be averaged there.
CodedOrder prediction_degree_order(const CornerTable& table);

}  // namespace vitrine::inline codec
