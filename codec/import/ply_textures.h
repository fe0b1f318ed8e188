// SPDX-License-Identifier: Apache-2.0
// The textures of a PLY file. Each picture becomes one material of the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/import/named_pictures.h"
#include "codec/import/ply_header.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

class PlyTextures {
 public:
  // Keeps the pictures of the TextureFile comments if the file has texture coordinates and, for
  // several pictures, a picture number for each face. Otherwise keeps no picture.
  PlyTextures(const PlyHeader& header, NamedPictures& pictures);

  // Whether no picture is kept.
  bool empty() const { return materials_.empty(); }

  // Returns the material of a face whose property texnumber is `number`.
  std::uint16_t material_of(std::uint32_t number);

  // Moves the materials to the mesh and reports what is not kept.
  void give_to(RawMesh& mesh);

 private:
  NamedPictures& pictures_;
  std::size_t count_;  // number of pictures in the header
  bool has_coordinates_, lacks_numbers_ = false;
  std::vector<Material> materials_;
};

// Decodes the pictures of the TextureFile comments. An entry is null if the picture cannot be
// decoded. Returns an empty list if the file lacks texture coordinates or, for several pictures, a
// picture number for each face.
std::vector<const Picture*> find_pictures(const PlyHeader& header, NamedPictures& pictures);

bool has_texture_coordinates(const PlyHeader& header);

// Whether the property is the list of texture coordinates at a face's corners.
inline bool is_texcoord(const PlyProperty& property) {
  return property.is_list && property.name == "texcoord";
}

// Whether the property is the number of a face's picture.
inline bool is_texnumber(const PlyProperty& property) {
  return !property.is_list && property.name == "texnumber";
}

// Each function returns whether the property is a texture coordinate of a vertex: u or v.
bool is_vertex_u(const PlyProperty& property);
bool is_vertex_v(const PlyProperty& property);

}  // namespace vitrine::inline codec
