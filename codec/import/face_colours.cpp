// SPDX-License-Identifier: Apache-2.0
#include "codec/import/face_colours.h"

#include <algorithm>

#include "codec/core/linear_colour.h"

namespace vitrine::inline codec {

void FaceColours::add(std::span<const std::uint32_t> corners, const StatedColour& colour) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ends_.push_back(corners_.size());
  colours_.push_back(colour);
}

bool FaceColours::are_all(const StatedColour& colour) const {
  return std::ranges::all_of(colours_, [&](const auto& other) { return other == colour; });
}

std::vector<Colour> FaceColours::means(RawMesh& mesh) const {
  const std::vector<Colour> of_faces = to_colours(colours_, mesh.repairs);
  ColourMeans means(mesh.positions.size());
  std::size_t begin = 0;
  for (std::size_t f = 0; f < ends_.size(); begin = ends_[f++]) {
    const LinearColour colour = to_linear(of_faces[f]);
    for (std::size_t c = begin; c < ends_[f]; ++c) {
      if (corners_[c] < mesh.positions.size()) means.add(corners_[c], colour);
    }
  }
  return means.take();
}

void FaceColours::give_to(RawMesh& mesh) const {
  if (colours_.empty() || are_all({1, 1, 1}) || are_all({255, 255, 255})) return;
  const std::string which = "colours of " + counted(colours_.size(), "face");
  if (!mesh.attributes.colours.empty()) {
    mesh.repairs.push_back(which + " not carried: the vertices have colours of their own");
    return;
  }
  mesh.attributes.colours = means(mesh);
  if (are_all(colours_[0])) return;
  mesh.repairs.push_back(which +
                         " averaged at the vertices; bake them into a texture map to keep their "
                         "borders sharp");
}

}  // namespace vitrine::inline codec
