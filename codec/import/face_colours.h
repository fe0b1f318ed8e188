// SPDX-License-Identifier: Apache-2.0
// The colours of faces, which become the mean colours of the vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/import/stated_colours.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

class FaceColours {
 public:
  // Adds a face and its colour. Corners that are out of range are ignored.
  void add(std::span<const std::uint32_t> corners, const StatedColour& colour);

  // Gives the mesh's vertices the mean colours of their faces, unless they have colours or all
  // faces are white, and reports what is lost. Call it when the mesh has all vertices.
  void give_to(RawMesh& mesh) const;

 private:
  bool are_all(const StatedColour& colour) const;
  std::vector<Colour> means(RawMesh& mesh) const;

  std::vector<std::uint32_t> corners_;  // of all faces
  std::vector<std::size_t> ends_;       // per face: end of its corners in corners_
  std::vector<StatedColour> colours_;   // per face
};

}  // namespace vitrine::inline codec
