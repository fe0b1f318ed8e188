// SPDX-License-Identifier: Apache-2.0
// Recognises materials that can be replaced by vertex colours.
#pragma once

#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Whether the roughness is the default of a material that states none, or the value in meshes that
// Vitrine exports without textures.
inline bool has_plain_roughness(const Material& material) {
  constexpr double kUnstated = 1, kExported = 0.8;
  return material.roughness == kUnstated || material.roughness == kExported;
}

// Whether vertex colours can replace the material: it has no maps and no special roughness, is not
// metallic, emits no light, is opaque and is not unlit. A mesh does not keep its materials if all
// of them are plain.
inline bool is_plain(const Material& material) {
  bool has_map = false;
  for_each_map(material, [&](const TextureMap&) { has_map = true; });
  return !has_map && has_plain_roughness(material) && material.metallic == 0 &&
         material.emission == Vec3{} && material.alpha_mode == AlphaMode::kOpaque &&
         !material.is_unlit;
}

}  // namespace vitrine::inline codec
