// SPDX-License-Identifier: Apache-2.0
// Tells an encoding LayerPass what the recorded collapses of one level undo.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/progressive/hierarchy.h"
#include "codec/progressive/layer_pass.h"

namespace vitrine {

class Replay {
 public:
  static constexpr std::uint32_t kNoCollapse = 0xFFFF'FFFFu;

  Replay(const CollapseLevel& collapses, const std::vector<std::uint32_t>& collapse_of,
         std::vector<VertexId>& fine, std::vector<VertexId>& state, const std::vector<Vec3i>& cell)
      : collapses_(collapses), collapse_of_(collapse_of), fine_(fine), state_(state), cell_(cell) {}

  Vec3i cell(VertexId v) const { return cell_[fine_[v]]; }

  bool find(VertexId v, SplitTruth& told) {
    const std::uint32_t k = collapse_of_[fine_[v]];
    if (k == kNoCollapse) return false;
    const Collapse& c = collapses_[k];
    // The new vertex is v2: its faces run from apex21 round to apex12.
    told = {to_state(c.apex21), to_state(c.apex12), c.p1 - c.p2, c.c1 - c.c2};
    return true;
  }

  void applied(VertexId v, VertexId w, bool swapped) {
    const Collapse& c = collapses_[collapse_of_[fine_[v]]];
    fine_.push_back(swapped ? c.v1 : c.v2);
    fine_[v] = swapped ? c.v2 : c.v1;
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

}  // namespace vitrine
