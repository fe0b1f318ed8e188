// SPDX-License-Identifier: Apache-2.0
#include "codec/repair/face_texturing.h"

#include <algorithm>
#include <cmath>

namespace vitrine::inline codec {
namespace {

// Removes the marked entries of a column that has one entry per face. An empty column stays empty.
template <class T>
void erase_marked(std::vector<T>& column, const std::vector<bool>& marked) {
  std::size_t kept = 0;
  for (std::size_t f = 0; f < column.size(); ++f) {
    if (!marked[f]) column[kept++] = column[f];
  }
  column.resize(kept);
}

}  // namespace

std::vector<std::array<TextureCoordinates, 3>> coordinates_of_corners(
    std::span<const Triangle> faces, std::span<const TextureCoordinates> of_vertices) {
  const auto at = [&](std::uint32_t v) {
    return v < of_vertices.size() ? of_vertices[v] : TextureCoordinates{};
  };
  std::vector<std::array<TextureCoordinates, 3>> out;
  out.reserve(faces.size());
  for (const auto& [a, b, c] : faces)
    out.push_back({at(a), at(b), at(c)});
  return out;
}

void fit_coordinate_sets(Texturing& texturing) {
  std::array<bool, kCoordinateSets> used{};
  for (const Material& material : texturing.materials)
    for_each_map(material, [&](const TextureMap& map) { used[map.coordinates] = true; });
  for (std::size_t s = 0; s < kCoordinateSets; ++s) {
    auto& set = texturing.coordinates[s];
    if (used[s])
      set.resize(texturing.face_materials.size());
    else
      set = {};
  }
}

std::uint64_t make_finite(Texturing& texturing) {
  std::uint64_t corners = 0;
  for (auto& set : texturing.coordinates) {
    for (auto& face : set) {
      for (TextureCoordinates& at : face) {
        if (std::isfinite(at[0]) && std::isfinite(at[1])) continue;
        for (float& value : at)
          value = std::isfinite(value) ? value : 0;
        ++corners;
      }
    }
  }
  return corners;
}

void erase_faces(Texturing& texturing, const std::vector<bool>& marked) {
  erase_marked(texturing.face_materials, marked);
  for (auto& set : texturing.coordinates)
    erase_marked(set, marked);
}

void reverse_face(Texturing& texturing, std::size_t face) {
  for (auto& set : texturing.coordinates) {
    if (!set.empty()) std::swap(set[face][1], set[face][2]);
  }
}

}  // namespace vitrine::inline codec
