// SPDX-License-Identifier: Apache-2.0
// Decides which maps of a material go into which picture of the display atlas.
#pragma once

#include <algorithm>
#include <span>

#include "codec/format/manifest.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

inline std::span<const MapOfMaterial> maps_of(PictureRole role) {
  static constexpr MapOfMaterial kColour[] = {&Material::base_colour_map};
  static constexpr MapOfMaterial kNormal[] = {&Material::normal_map};
  static constexpr MapOfMaterial kSurface[] = {&Material::metallic_roughness_map,
                                               &Material::occlusion_map};
  static constexpr MapOfMaterial kEmission[] = {&Material::emission_map};
  switch (role) {
    case PictureRole::kBaseColour:
      return kColour;
    case PictureRole::kNormal:
      return kNormal;
    case PictureRole::kSurface:
      return kSurface;
    case PictureRole::kEmission:
      return kEmission;
  }
  return {};
}

inline bool has_map(const Material& material, PictureRole role) {
  return std::ranges::any_of(maps_of(role),
                             [&](MapOfMaterial map) { return (material.*map).has_value(); });
}

// Whether a material needs the picture of a role. The picture of base colours is always needed.
// Without the other pictures, a surface has no relief, is matt and not metallic, and emits no
// light.
inline bool needs(const Material& material, PictureRole role) {
  switch (role) {
    case PictureRole::kBaseColour:
      return true;
    case PictureRole::kNormal:
      return has_map(material, role);
    case PictureRole::kSurface:
      return has_map(material, role) || material.metallic != 0 || material.roughness != 1;
    case PictureRole::kEmission:
      return material.emission != Vec3{};
  }
  return false;
}

// Whether the bytes of a picture of this role are sRGB.
inline bool is_srgb(PictureRole role) {
  return role == PictureRole::kBaseColour || role == PictureRole::kEmission;
}

}  // namespace vitrine::inline codec
