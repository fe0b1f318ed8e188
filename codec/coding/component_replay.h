// SPDX-License-Identifier: Apache-2.0
// Supplies the recorded components to the ComponentPass of an encoder.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/component_pass.h"
#include "codec/format/hierarchy.h"

namespace vitrine::inline codec {

class ComponentReplay {
 public:
  ComponentReplay(std::span<const Component* const> components, std::vector<VertexId>& fine,
                  std::vector<VertexId>& state)
      : components_(components), fine_(fine), state_(state) {}

  // Returns the vertex whose position is the smallest in the component, in lexicographic order.
  // Components are coded in the order of these positions.
  static std::uint32_t first_vertex(const Component& component) {
    const auto& cells = component.mesh.positions;
    return static_cast<std::uint32_t>(std::ranges::min_element(cells) - cells.begin());
  }

  void next() {
    now_ = components_[0];
    components_ = components_.subspan(1);
    met_.clear();
    const std::uint32_t first = first_vertex(*now_);
    for (Triangle face : now_->mesh.faces) {
      const auto at = std::ranges::find(face, first);
      if (at == face.end()) continue;
      std::rotate(face.begin(), at, face.end());
      met_.assign(face.begin(), face.end());
      return;
    }
  }

  std::uint32_t third(std::uint32_t from, std::uint32_t to) {
    for (const Triangle& face : now_->mesh.faces) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (face[k] == met_[from] && face[(k + 1) % 3] == met_[to])
          return number(face[(k + 2) % 3]);
      }
    }
    return kNoThird;
  }

  Vec3i cell(std::uint32_t v) const { return now_->mesh.positions[met_[v]]; }
  Vec3i value(std::size_t i, std::uint32_t v) const {
    return now_->mesh.attributes[i].values[met_[v]];
  }

  void added() {
    for (const std::uint32_t v : met_) {
      state_[now_->ids[v]] = static_cast<VertexId>(fine_.size());
      fine_.push_back(now_->ids[v]);
    }
  }

 private:
  std::uint32_t number(std::uint32_t vertex) {
    const auto at = std::ranges::find(met_, vertex);
    const auto v = static_cast<std::uint32_t>(at - met_.begin());
    if (at == met_.end()) met_.push_back(vertex);
    return v;
  }

  std::span<const Component* const> components_;  // components still to be coded
  std::vector<VertexId>& fine_;
  std::vector<VertexId>& state_;
  const Component* now_ = nullptr;
  // The current component's vertices, in the order in which the pass reaches them.
  std::vector<std::uint32_t> met_;
};

}  // namespace vitrine::inline codec
