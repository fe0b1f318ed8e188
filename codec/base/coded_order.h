// SPDX-License-Identifier: Apache-2.0
// The two orders in which Draco can code the values of an attribute. Each is the order in which a
// certain walk over the faces reaches the vertices. Internal to codec/base.
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

// Walk that visits faces with three known vertices first. Next come faces whose unknown vertex
// adjoins several visited faces, because several predictions of that vertex can be averaged.
CodedOrder prediction_degree_order(const CornerTable& table);

}  // namespace vitrine::inline codec
