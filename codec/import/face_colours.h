// SPDX-License-Identifier: Apache-2.0
// Converts colours of faces, or of their corners, to vertex colours: each vertex gets the mean of
// the colours that its faces have there.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/import/stated_colours.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

class FaceColours {
 public:
  // Adds a face and its colour. Ignores corners that are out of range.
  void add(std::span<const std::uint32_t> corners, const StatedColour& colour);
  // Adds a triangle and the colours of its corners.
  void add(const Triangle& corners, const std::array<StatedColour, 3>& colours);

  // Sets the colour of each vertex to the mean of the colours that its faces have there, and
  // reports which colours are lost. Leaves the mesh unchanged if all faces are white or if the mesh
  // already has vertex colours. Call this once the mesh has all its vertices.
  void give_to(RawMesh& mesh) const;

 private:
  void add_patch(std::span<const std::uint32_t> corners, const StatedColour& colour);
  bool are_all(const StatedColour& colour) const;
  // Calls visit(vertex, patch) for each corner of each patch.
  template <class Visit>
  void for_each_corner(std::size_t vertices, const Visit& visit) const;

  std::uint64_t faces_ = 0;
  // The corners of a face that have one colour are a patch.
  std::vector<std::uint32_t> corners_;  // corners of all patches, patch by patch
  std::vector<std::size_t> ends_;       // per patch: the end of its corners in corners_
  std::vector<StatedColour> colours_;   // per patch: its colour
};

}  // namespace vitrine::inline codec
