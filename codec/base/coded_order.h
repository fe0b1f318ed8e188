// SPDX-License-Identifier: Apache-2.0
// The order in which Draco codes the values of an attribute: that in which a walk over the faces
// reaches the vertices. Internal to codec/base.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/base/corner_table.h"

namespace vitrine::inline codec {

struct CodedOrder {
  std::vector<Corner> corner;       // per value: the corner at which its vertex is reached
  std::vector<std::uint32_t> rank;  // per vertex: the number of its value
};

// Walks into one direction as far as possible, then back to the last face with another neighbour.
CodedOrder depth_first_order(const CornerTable& table);

// Prefers faces whose vertices are known, then those whose new vertex can be predicted from several
// faces.
CodedOrder prediction_degree_order(const CornerTable& table);

}  // namespace vitrine::inline codec
