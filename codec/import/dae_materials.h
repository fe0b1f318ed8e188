// SPDX-License-Identifier: Apache-2.0
// Reads the materials of a COLLADA file.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "codec/import/dae_document.h"
#include "codec/import/obj_materials.h"

namespace vitrine::inline codec {

class DaeMaterials {
 public:
  // `work` counts the bytes read. The arguments must outlive this object.
  DaeMaterials(const DaeDocument& document, DaeWork& work, ObjMaterials& materials)
      : document_(document), work_(work), materials_(materials) {}

  // Binds symbols to materials. `instance` is the element that places a geometry; it states which
  // material each symbol of the geometry means.
  void bind(const DaeNode& instance);
  // Returns the name of the material to which a primitive's symbol is bound. The first call for a
  // material also defines it. Returns an empty name if there is no such material.
  std::string define(std::string_view symbol);

 private:
  ObjMaterial read(const DaeNode& material) const;
  void read_technique(const DaeNode& effect, const DaeNode& technique, ObjMaterial& out) const;
  void read_opacity(const DaeNode& effect, const DaeNode& shader, ObjMaterial& out) const;
  ObjMap map(const DaeNode& effect, const DaeNode& channel) const;

  const DaeDocument& document_;
  DaeWork& work_;
  ObjMaterials& materials_;
  std::map<std::string_view, DaeNode> bound_;  // symbol -> element of the material
  // Key: hash value of an element. Value: the name of the material that was defined, or an empty
  // string if the element is not a material.
  std::map<std::size_t, std::string> defined_;
};

}  // namespace vitrine::inline codec
