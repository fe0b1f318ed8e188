// SPDX-License-Identifier: Apache-2.0
// The textures of a PLY file, as a mesh carries them: one material for each picture.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/import/named_pictures.h"
#include "codec/import/ply_header.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

class PlyTextures {
 public:
  // Carries the pictures of the TextureFile comments if the file has texture coordinates and, with
  // more than one picture, says which of them a face uses.
  PlyTextures(const PlyHeader& header, NamedPictures& pictures);

  // Whether the mesh carries no picture.
  bool empty() const { return materials_.empty(); }

  // Returns the material of a face with this texnumber.
  std::uint16_t material_of(std::uint32_t number);

  // Moves the materials to the mesh and reports what is not carried.
  void give_to(RawMesh& mesh);

 private:
  NamedPictures& pictures_;
  std::size_t count_;  // number of pictures in the header
  bool lacks_numbers_ = false;
  std::vector<Material> materials_;
};

// Whether the property is the list of the texture coordinates of a face's corners.
inline bool is_texcoord(const PlyProperty& property) {
  return property.is_list && property.name == "texcoord";
}

// Whether the property is the number of the picture that a face uses.
inline bool is_texnumber(const PlyProperty& property) {
  return !property.is_list && property.name == "texnumber";
}

// Whether the property is the texture coordinate u, or v, of a vertex.
bool is_vertex_u(const PlyProperty& property);
bool is_vertex_v(const PlyProperty& property);

}  // namespace vitrine::inline codec
