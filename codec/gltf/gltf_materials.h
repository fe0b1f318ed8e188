// SPDX-License-Identifier: Apache-2.0
// The materials of a glTF document and their texture maps, in the form in which a mesh stores them.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "codec/core/limits.h"
#include "codec/gltf/gltf_pictures.h"
#include "codec/mesh/texturing.h"
#include "codec/picture/carried_pictures.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

class GltfMaterials {
 public:
  // The references must outlive this object.
  GltfMaterials(const Json& document, GltfPictures& pictures, const GltfBuffer& buffer,
                const Limits& limits)
      : document_(document), pictures_(pictures), buffer_(buffer), limits_(limits) {}

  // Returns the index of the primitive's material among the materials read. If a map's picture
  // cannot be kept, the map is left out, and the fault goes to GltfPictures::refuse().
  std::uint16_t index_of(const Json& primitive);

  const Material& operator[](std::uint16_t index) const { return materials_[index]; }

  // Moves the materials and pictures to the mesh. Drops them instead if vertex colours can replace
  // all materials (is_plain()).
  void give_to(RawMesh& mesh);

  // Returns one line for each kind of material property that is not kept.
  std::vector<std::string> report() const;

 private:
  Material read(const Json& self);
  std::optional<TextureMap> map(const Json& reference);
  // Returns the index of an image among the pictures that are kept, or nullopt if the image cannot
  // be kept.
  std::optional<std::uint32_t> carry(std::uint64_t image);
  void note_extensions(const Json& self);

  const Json& document_;
  GltfPictures& pictures_;
  const GltfBuffer& buffer_;
  const Limits& limits_;
  CarriedPictures carried_;
  // Index of an image in the document -> index of its picture in `carried_`. Each image is thus
  // added only once, and its name, which may be a long data: URI, is read only once.
  std::map<std::uint64_t, std::uint32_t> carried_images_;
  std::vector<Material> materials_;
  // Index of a material in the document -> its index in `materials_`. The key of the material for
  // primitives without one is kAbsent.
  std::map<std::uint64_t, std::uint16_t> indices_;
  std::set<std::string> unread_extensions_;
  std::uint64_t glossy_materials_ = 0, maps_beyond_sets_ = 0, materials_beyond_limit_ = 0;
};

}  // namespace vitrine::inline codec
