// SPDX-License-Identifier: Apache-2.0
// The diffuse colours of OBJ materials: `Kd` and `map_Kd` in material libraries.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "codec/import/named_pictures.h"

namespace vitrine::inline codec {

class ObjMaterials {
 public:
  ObjMaterials(const Companions& companions, std::uint64_t most_pixels)
      : companions_(companions), pictures_(companions, most_pixels) {}

  // Reads a material library. Returns false if it is not among the companions.
  bool open_library(std::string_view name);

  // Selects the current material. An unknown material is white.
  void use(std::string_view name);
  bool has_current() const { return current_ != nullptr; }

  // Returns the colour of the current material at (u, v), where (0, 0) is the lower left corner. If
  // the material has a picture, returns only the picture's colour, as most programs do. Otherwise
  // returns Kd, taken as sRGB.
  LinearColour colour_at(double u, double v) const;

  std::vector<std::string> report() const;

 private:
  struct Material {
    LinearColour diffuse{1, 1, 1};
    std::string map;
    const Picture* picture = nullptr;  // loaded when the material is first used
    bool is_used = false;
  };

  const Companions& companions_;
  NamedPictures pictures_;
  std::map<std::string, Material, std::less<>> materials_;
  const Material* current_ = nullptr;
};

}  // namespace vitrine::inline codec
