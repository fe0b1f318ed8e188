// SPDX-License-Identifier: Apache-2.0
// Which small components leave the mesh on the way to the base, and when: each level does without
// those that are smaller than its error, or without as many as keep the base from getting small.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/progressive/hierarchy.h"
#include "codec/simplify/surface.h"

namespace vitrine {

class SmallComponents {
 public:
  // All components of the fine mesh but the one with the largest box.
  explicit SmallComponents(const Surface& surface);

  struct Need {
    double error;          // of the level at hand, lattice units
    std::size_t vertices;  // that the mesh should have at most
  };
  // Takes components out of the surface that collapses do not make smaller any more and that are in
  // one region: those that the level hides, then the smallest ones until there are few enough
  // vertices. They come back as they are at this level.
  std::vector<Component> leave(Surface& surface, const Need& need);

  std::size_t vertices() const { return vertices_; }  // of those that have not left, at most

 private:
  struct Part {
    std::size_t begin, size;  // in members_
    bool shrank = true;       // since it was last looked at
  };

  void update(const Surface& surface);

  std::vector<VertexId> members_;  // the vertices of each part, ascending
  std::vector<Part> parts_;
  std::size_t vertices_ = 0;
};

}  // namespace vitrine
