// SPDX-License-Identifier: Apache-2.0
// Supplies the splits of one level to the encoder's LayerPass. Each split undoes one recorded
// collapse.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/coding/layer_pass.h"
#include "codec/format/hierarchy.h"

namespace vitrine::inline codec {

class CollapseReplay {
 public:
  static constexpr std::uint32_t kNoCollapse = 0xFFFF'FFFFu;

  CollapseReplay(const CollapseLevel& collapses, const std::vector<std::uint32_t>& collapse_of,
                 std::vector<VertexId>& fine, std::vector<VertexId>& state,
                 const std::vector<Vec3i>& cell)
      : collapses_(collapses), collapse_of_(collapse_of), fine_(fine), state_(state), cell_(cell) {}

  Vec3i cell(VertexId v) const { return cell_[fine_[v]]; }

  bool find(VertexId v, SplitTruth& told) {
    const std::uint32_t k = collapse_of_[fine_[v]];
    if (k == kNoCollapse) return false;
    const Collapse& c = collapses_[k];
    // The split creates the vertex v2 of the recorded collapse. v2 takes the faces from apex21 to
    // apex12.
    told = {.qi = to_state(c.apex21), .qj = to_state(c.apex12), .d = c.p1 - c.p2};
    for (std::size_t i = 0; i < kSemantics; ++i)
      told.attribute_d[i] = c.a1[i] - c.a2[i];
    return true;
  }

  void applied(VertexId v, VertexId w, bool is_swapped) {
    const Collapse& c = collapses_[collapse_of_[fine_[v]]];
    fine_.push_back(is_swapped ? c.v1 : c.v2);
    fine_[v] = is_swapped ? c.v2 : c.v1;
    state_[fine_[v]] = v;
    state_[fine_[w]] = w;
  }

 private:
  VertexId to_state(VertexId fine) const { return is_virtual(fine) ? fine : state_[fine]; }

  const CollapseLevel& collapses_;
  const std::vector<std::uint32_t>& collapse_of_;
  std::vector<VertexId>& fine_;
  std::vector<VertexId>& state_;
  const std::vector<Vec3i>& cell_;
};

}  // namespace vitrine::inline codec
