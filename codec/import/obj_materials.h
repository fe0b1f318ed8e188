// SPDX-License-Identifier: Apache-2.0
// The diffuse colours of OBJ materials: `Kd` and `map_Kd` of their libraries.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "codec/import/named_pictures.h"

namespace vitrine {

class ObjMaterials {
 public:
  explicit ObjMaterials(const Companions& companions)
      : companions_(companions), pictures_(companions) {}

  // Reads a library of materials. False where it is not among the companions.
  bool open_library(std::string_view name);

  // Makes a material the current one; an unknown one is white.
  void use(std::string_view name);
  bool has_current() const { return current_ != nullptr; }

  // Of the current material at (u, v), whose origin is the lower left corner: the picture alone
  // where there is one, as most programs show it, else Kd, taken as sRGB.
  LinearColour colour_at(double u, double v) const;

  std::vector<std::string> report() const;

 private:
  struct Material {
    LinearColour diffuse{1, 1, 1};
    std::string map;
    const Image* picture = nullptr;  // looked for when the material is first used
    bool is_used = false;
  };

  const Companions& companions_;
  NamedPictures pictures_;
  std::map<std::string, Material, std::less<>> materials_;
  const Material* current_ = nullptr;
};

}  // namespace vitrine
