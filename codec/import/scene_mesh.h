// SPDX-License-Identifier: Apache-2.0
// Collects the polygons of a scene (DAE, FBX) with their materials, colours and texture
// coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/linear_colour.h"
#include "codec/gltf/affine.h"
#include "codec/import/obj_materials.h"
#include "codec/import/stated_colours.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

struct SceneCorner {
  std::uint32_t vertex = 0;
  std::array<float, 2> place{};     // texture coordinates; (0, 0) is the lower left corner
  StatedColour colour = kNoColour;  // in sRGB, each component from 0 to 1
};

class SceneMesh {
 public:
  // `room` is the maximum number of vertices, of corners and of parts (add_part()). The other
  // arguments must outlive this object.
  SceneMesh(std::string_view format, const Companions& companions, const Limits& limits,
            std::uint64_t room);

  // Define a material here before add_part() selects it.
  ObjMaterials& materials() { return materials_; }
  void note(std::string line) { notes_.push_back(std::move(line)); }

  // Begins a part of the scene, whose faces have this material. An empty name means no material.
  // Fails (kLimit) if there would be more than `room` parts.
  Expected<void> add_part(std::string_view material);
  // Adds a vertex. Fails (kLimit) if there would be more than `room` vertices.
  Expected<void> add_vertex(const Vec3& position);
  std::size_t vertices() const { return mesh_.positions.size(); }
  // Adds a face. Reverses its corners if the part is mirrored. Fails (kLimit) if there would be
  // more than `room` corners.
  Expected<void> add_face(std::span<SceneCorner> corners, bool is_mirrored);

  bool has_faces() const { return mesh_.face_count() > 0; }
  RawMesh finish() &&;

 private:
  Unexpected too_many() const;
  void take_colours();

  RawMesh mesh_;
  ObjMaterials materials_;
  ColourMeans own_, baked_;  // mean colours of vertices: from SceneCorner::colour, from materials
  std::vector<std::uint32_t> corners_;
  std::vector<TextureCoordinates> at_corners_;
  std::vector<std::string> notes_;
  std::uint64_t room_, all_corners_ = 0, parts_ = 0;
};

// Returns the map that rotates positions to y up and then scales them. `up_axis` is the axis that
// points up in the file: 0 for x, 1 for y, 2 for z.
Affine to_y_up(int up_axis, double scale);

}  // namespace vitrine::inline codec
