// SPDX-License-Identifier: Apache-2.0
// Converts colours of faces to vertex colours: each vertex gets the mean colour of its faces.
#pragma once

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

  // Sets the colour of each vertex to the mean colour of its faces, and reports which colours are
  // lost. Leaves the mesh unchanged if all faces are white or if the mesh already has vertex
  // colours. Call this once the mesh has all its vertices.
  void give_to(RawMesh& mesh) const;

 private:
  bool are_all(const StatedColour& colour) const;
  std::vector<Colour> means(RawMesh& mesh) const;

  std::vector<std::uint32_t> corners_;  // corners of all faces, face by face
  std::vector<std::size_t> ends_;       // per face: the end of its corners in corners_
  std::vector<StatedColour> colours_;   // per face: its colour
};

}  // namespace vitrine::inline codec
