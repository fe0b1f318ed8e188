// SPDX-License-Identifier: Apache-2.0
// The materials of an OBJ, DAE or FBX file: the vertex colours they give, and the materials that
// the mesh keeps.
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

  // Reads a material library, unless it was read before. Fails like find_companion(), and if the
  // library is UTF-16 text.
  Expected<void> open_library(std::string_view name);

  // Adds a material to the library, or replaces the material of the same name.
  void define(std::string name, ObjMaterial material);

  // Selects the current material and returns its index among the kept materials. An unknown
  // material is white, and is reported if any library was read.
  std::uint16_t use(std::string_view name);
  // Number of materials in use.
  std::uint64_t used() const { return used_.size(); }
  bool has_current() const { return current_ != nullptr; }
  // Returns the index of the material for faces that have none.
  std::uint16_t plain();

  // Whether any used material has a texture map.
  bool has_maps() const { return has_maps_; }

  // Returns the colour of the current material at (u, v), where (0, 0) is the lower left corner. If
  // the material has a picture, this is the picture's colour alone, as in most programs. Otherwise,
  // it is the diffuse colour Kd, taken as sRGB, or the emission if Kd is black.
  LinearColour colour_at(double u, double v) const;

  // Whether vertex colours can express everything that the materials state.
  bool are_plain() const;

  // Moves the materials and pictures to the mesh, unless are_plain().
  void give_to(RawMesh& mesh);

  // Returns lines for the user about materials that became vertex colours.
  std::vector<std::string> report_baked() const;
  // Returns one line for each kind of material property that is not kept, and one about unknown
  // materials.
  std::vector<std::string> report_unread() const;

 private:
  struct UsedMaterial {
    LinearColour diffuse{1, 1, 1};
    const Picture* picture = nullptr;
    ObjMap map;  // how the material uses the picture
    std::uint16_t index = 0;
  };

  const UsedMaterial* find(std::string_view name);
  void bake(const ObjMaterial& source, UsedMaterial& out);
  std::uint16_t carry(std::string name, const ObjMaterial& source, const UsedMaterial& used);
  void carry_other_maps(const ObjMaterial& source, Material& out);
  std::optional<TextureMap> map(const ObjMap& source);

  const Companions& companions_;
  NamedPictures pictures_;
  std::map<std::string, std::string> opened_;  // libraries read: key -> folder (see StatedPath)
  ObjLibrary library_;
  bool has_library_ = false;
  std::set<std::string, std::less<>> unknown_;  // used materials that no library defines
  std::map<std::string, UsedMaterial, std::less<>> used_;
  const UsedMaterial* current_ = nullptr;
  std::vector<Material> carried_;
  std::optional<std::uint16_t> plain_;  // result of plain(); nullopt before the first call
  std::set<std::string_view> unread_;   // map statements that are not read
  std::map<std::string_view, std::uint64_t> diffuse_faults_;  // fault -> number of used materials
  std::uint64_t beyond_limit_ = 0;  // number of used materials that are not kept
  bool has_maps_ = false;
};

}  // namespace vitrine::inline codec
