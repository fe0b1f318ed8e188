// SPDX-License-Identifier: Apache-2.0
// Converts colours that a file states as real numbers, for vertices, faces or corners of faces.
// Their range is either 0 to 1 or 0 to 255.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "codec/core/vec.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

using StatedColour = std::array<float, 3>;  // red, green and blue

// Stands for a vertex or face without a colour. Such a vertex or face becomes white.
inline constexpr StatedColour kNoColour{std::numeric_limits<float>::quiet_NaN(), 0, 0};

// Whether a stated opacity is less than full. The range of opacities is 0 to 1 or 0 to 255.
inline bool is_translucent(double opacity) {
  return opacity < 1 || (opacity > 1 && opacity < 255);
}

// Whether the values of a file range from 0 to 255 rather than from 0 to 1. A few values slightly
// above 1 still count as the range 0 to 1.
bool are_up_to_255(std::span<const StatedColour> stated);

// Scales colours that a file states as integers of 16 or more bits. If a value is above 510, their
// range is 0 to 65535, and they are scaled to the range 0 to 1. Otherwise they stay: a few values
// up to twice 255 still count as the range 0 to 255.
void scale_wide_integers(std::span<StatedColour> stated);

// Counts the values of colours that are out of range, and the colours that are missing.
class ColourFaults {
 public:
  // `is_wide`: the range of the colour is 0 to 255 rather than 0 to 1
  void count(const StatedColour& colour, bool is_wide);
  // Returns one line for each kind of fault.
  std::vector<std::string> report() const;

 private:
  std::uint64_t above_1_ = 0, above_255_ = 0, below_ = 0, missing_ = 0;
};

// Converts all colours of a file. Adds lines to `repairs` if values out of range were clipped, or
// if some colours are missing.
std::vector<Colour> to_colours(std::span<const StatedColour> stated,
                               std::vector<std::string>& repairs);

// Returns a line about vertices or faces that lack a colour although others have one.
std::string report_uncoloured(std::uint64_t count);

// Converts colours of faces, or of their corners, to vertex colours: each vertex gets the mean
// colour of the face corners at the vertex.
class FaceColours {
 public:
  // Adds a face and its colour. Ignores corners that are out of range.
  void add(std::span<const std::uint32_t> corners, const StatedColour& colour);
  // Adds a triangle and the colours of its corners.
  void add(const Triangle& corners, const std::array<StatedColour, 3>& colours);

  // Scales the colours of all faces; see the function above.
  void scale_wide_integers() { vitrine::scale_wide_integers(colours_); }

  // Sets the colour of each vertex to the mean colour of the face corners at the vertex, and
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
  // A patch is a group of corners of one face that have the same colour.
  std::vector<std::uint32_t> corners_;  // corners of all patches, patch by patch
  std::vector<std::size_t> ends_;       // per patch: the end of its corners in corners_
  std::vector<StatedColour> colours_;   // per patch: its colour
};

}  // namespace vitrine::inline codec
