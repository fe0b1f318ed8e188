// SPDX-License-Identifier: Apache-2.0
// Chooses small components that are removed between the fine mesh and the base mesh. A level omits
// the components that are smaller than the level's error. It omits more components if the base mesh
// would otherwise have too many vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/format/hierarchy.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

class SmallComponents {
 public:
  // Considers all components of the fine mesh except the one with the largest bounding box.
  explicit SmallComponents(const Surface& surface);

  struct Need {
    double error;          // rms error of the current level in lattice units
    std::size_t vertices;  // number of vertices that the mesh should not exceed
  };
  // Removes components from the surface: first those hidden by the level's error, then the smallest
  // ones until the mesh has few enough vertices. A component is removed only if it lies in one
  // region and is tiny or no longer shrinks. Returns the removed components in their state in this
  // level.
  std::vector<Component> leave(Surface& surface, const Need& need);

  // Returns an upper bound on the number of vertices left in the considered components.
  std::size_t vertices() const { return vertices_; }

 private:
  struct MemberRange {
    // The component's vertices in members_: index of the first, and their number.
    std::size_t begin, size;
    bool has_shrunk = true;  // whether the last update() found fewer vertices than before
  };

  void update(const Surface& surface);

  std::vector<VertexId> members_;  // vertices of all components, sorted within each component
  std::vector<MemberRange> ranges_;
  std::size_t vertices_ = 0;
};

}  // namespace vitrine::inline codec
