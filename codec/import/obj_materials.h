// SPDX-License-Identifier: Apache-2.0
// The materials of an OBJ file: their colours for the vertices, and what the mesh carries of them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/limits.h"
#include "codec/import/named_pictures.h"
#include "codec/import/obj_library.h"
#include "codec/mesh/texturing.h"
#include "codec/repair/raw_mesh.h"

namespace vitrine::inline codec {

class ObjMaterials {
 public:
  // `companions` must outlive this object.
  ObjMaterials(const Companions& companions, const Limits& limits)
      : companions_(companions), pictures_(companions, limits) {}

  // Reads a material library, unless it was read before. Returns false if it is not among the
  // companions.
  bool open_library(std::string_view name);

  // Selects the current material and returns its index among the carried ones. An unknown material
  // is white, and reported if a library was read.
  std::uint16_t use(std::string_view name);
  bool has_current() const { return current_ != nullptr; }
  // Returns the index of the material of faces that have none.
  std::uint16_t plain();

  // Whether a material that was used has a map.
  bool has_maps() const { return has_maps_; }

  // Returns the colour of the current material at (u, v), where (0, 0) is the lower left corner. If
  // the material has a picture, returns only the picture's colour, as most programs do. Otherwise
  // returns Kd, taken as sRGB. A black material shows its emission instead.
  LinearColour colour_at(double u, double v) const;

  // Moves the materials and pictures to the mesh, unless all materials are plain.
  void give_to(RawMesh& mesh);

  // Reports what was baked into vertex colours.
  std::vector<std::string> report_baked() const;
  // Reports what is not carried, one line for each kind.
  std::vector<std::string> report_unread() const;

 private:
  struct UsedMaterial {
    LinearColour diffuse{1, 1, 1};
    const Picture* picture = nullptr;
    ObjMap map;  // the use of the picture
    std::uint16_t index = 0;
  };

  const UsedMaterial* find(std::string_view name);
  void bake(const ObjMaterial& source, UsedMaterial& out);
  std::uint16_t carry(std::string name, const ObjMaterial& source, const UsedMaterial& used);
  void carry_other_maps(const ObjMaterial& source, Material& out);
  std::optional<TextureMap> map(const ObjMap& source);

  const Companions& companions_;
  NamedPictures pictures_;
  std::set<std::string> opened_;  // libraries; keys of companions_
  ObjLibrary library_;
  bool has_library_ = false;
  std::set<std::string, std::less<>> unknown_;  // names of materials that no library has
  std::map<std::string, UsedMaterial, std::less<>> used_;
  const UsedMaterial* current_ = nullptr;
  std::vector<Material> carried_;
  std::optional<std::uint16_t> plain_;  // the index that plain() returned
  std::set<std::string_view> unread_;   // statements of maps that are not read
  std::uint64_t beyond_limit_ = 0;      // number of used materials that are not carried
  bool has_maps_ = false;
};

}  // namespace vitrine::inline codec
