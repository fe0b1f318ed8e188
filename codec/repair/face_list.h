// SPDX-License-Identifier: Apache-2.0
// The faces of a mesh as in its file: with any number of corners, and optionally with materials and
// with texture coordinates per corner.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/vec.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

class FaceList {
 public:
  std::vector<Triangle> triangles;  // complete after cut_polygons()
  // Per triangle: the texture coordinates of its corners. Empty if no face has coordinates. A face
  // that was added without coordinates has (0, 0) at each corner.
  std::vector<std::array<TextureCoordinates, 3>> coordinates;

  bool empty() const { return triangles.empty() && polygon_ends_.empty(); }

  void add(const Triangle& face) {
    triangles.push_back(face);
    if (!coordinates.empty()) coordinates.emplace_back();
  }

  // Adds a face with at least three corners. `at_corners` has one entry per corner, or is empty.
  void add(std::span<const std::uint32_t> corners, std::span<const TextureCoordinates> at_corners);

  // Sets the material of all faces added after this call. The initial material is 0.
  void use_material(std::uint16_t material);

  // Removes materials and texture coordinates. Call this before cut_polygons().
  void drop_texturing();

  // Cuts each face with more than three corners into triangles and appends these to `triangles`.
  void cut_polygons(std::span<const Vec3> positions);

  // Returns the material of each triangle. Call this after cut_polygons().
  std::vector<std::uint16_t> take_materials();

 private:
  // A run of faces with the same material. `triangle` and `polygon` are the indices of the first
  // triangle and the first polygon in the run.
  struct MaterialRun {
    std::size_t triangle, polygon;
    std::uint16_t material;
  };

  void add_polygon(std::span<const std::uint32_t> corners,
                   std::span<const TextureCoordinates> at_corners);
  void reserve_for_polygons();
  std::vector<std::uint16_t> expanded_runs() const;

  std::vector<std::uint32_t> polygon_corners_;  // corners of all polygons
  // one per entry of polygon_corners_, or empty
  std::vector<TextureCoordinates> polygon_coordinates_;
  std::vector<std::size_t> polygon_ends_;  // per polygon: end index in polygon_corners_
  std::vector<MaterialRun> runs_;          // in ascending order; empty if all materials are 0
  std::vector<std::uint16_t> materials_;   // material per triangle; empty if all are 0
};

}  // namespace vitrine::inline codec
