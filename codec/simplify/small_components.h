// SPDX-License-Identifier: Apache-2.0
// Chooses the small components to remove on the way to the base mesh. A level omits the components
// that are smaller than its error. It omits more of them if the base mesh would not get small
// enough otherwise.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/format/hierarchy.h"
#include "codec/simplify/surface.h"

namespace vitrine::inline codec {

class SmallComponents {
 public:
  // Considers all components of the fine mesh except the one with the largest box.
  explicit SmallComponents(const Surface& surface);

  struct Need {
    double error;          // rms error of the current level, lattice units
    std::size_t vertices;  // maximum number of vertices that the mesh should have
  };
  // Removes components from the surface: first those that the level's error hides, then the
  // smallest ones until the mesh has few enough vertices. A component is removed only if it lies in
  // one region, and if it is tiny or collapses no longer shrink it. Returns the removed components
  // as they were in this level.
  std::vector<Component> leave(Surface& surface, const Need& need);

  // Returns an upper bound on the number of vertices that remain in the considered components.
  std::size_t vertices() const { return vertices_; }

 private:
  struct MemberRange {
    // Index in members_ of the component's first vertex, and number of its vertices.
    std::size_t begin, size;
    bool has_shrunk = true;  // whether the last update() found fewer vertices than the one before
  };

  void update(const Surface& surface);

  std::vector<VertexId> members_;  // vertices of each component, ascending
  std::vector<MemberRange> ranges_;
  std::size_t vertices_ = 0;
};

}  // namespace vitrine::inline codec
