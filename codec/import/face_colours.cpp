// SPDX-License-Identifier: Apache-2.0
#include "codec/import/face_colours.h"

#include <algorithm>

#include "codec/core/linear_colour.h"

namespace vitrine::inline codec {

void FaceColours::add_patch(std::span<const std::uint32_t> corners, const StatedColour& colour) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ends_.push_back(corners_.size());
  colours_.push_back(colour);
}

void FaceColours::add(std::span<const std::uint32_t> corners, const StatedColour& colour) {
  ++faces_;
  add_patch(corners, colour);
}

void FaceColours::add(const Triangle& corners, const std::array<StatedColour, 3>& colours) {
  if (colours[0] == colours[1] && colours[1] == colours[2]) return add(corners, colours[0]);
  ++faces_;
  for (std::size_t k = 0; k < 3; ++k)
    add_patch({&corners[k], 1}, colours[k]);
}

bool FaceColours::are_all(const StatedColour& colour) const {
  return std::ranges::all_of(colours_, [&](const auto& other) { return other == colour; });
}

template <class Visit>
void FaceColours::for_each_corner(std::size_t vertices, const Visit& visit) const {
  std::size_t begin = 0;
  for (std::size_t patch = 0; patch < ends_.size(); begin = ends_[patch++]) {
    for (std::size_t c = begin; c < ends_[patch]; ++c) {
      if (corners_[c] < vertices) visit(corners_[c], patch);
    }
  }
}

void FaceColours::give_to(RawMesh& mesh) const {
  if (colours_.empty() || are_all({1, 1, 1}) || are_all({255, 255, 255})) return;
  const std::string which = "colours of " + counted(faces_, "face");
  if (!mesh.attributes.colours.empty()) {
    mesh.repairs.push_back(which + " not carried: the vertices have colours of their own");
    return;
  }
  const std::size_t vertices = mesh.positions.size();
  const std::vector<Colour> stated = to_colours(colours_, mesh.repairs);
  ColourMeans means(vertices);
  for_each_corner(vertices, [&](std::uint32_t v, std::size_t patch) {
    means.add(v, to_linear(stated[patch]));
  });
  mesh.attributes.colours = means.take();
  bool is_lossless = true;
  for_each_corner(vertices, [&](std::uint32_t v, std::size_t patch) {
    is_lossless = is_lossless && mesh.attributes.colours[v] == stated[patch];
  });
  if (is_lossless) return;
  mesh.repairs.push_back(which +
                         " averaged at the vertices; bake them into a texture map to keep their "
                         "borders sharp");
}

}  // namespace vitrine::inline codec
