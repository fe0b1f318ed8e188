// SPDX-License-Identifier: Apache-2.0
// Finds materials that vertex colours can replace.
#pragma once

#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

// Whether a material adds nothing to colours: it has no maps, is not metallic, emits no light, is
// opaque and is lit. Meshes whose materials are all plain do not carry them.
inline bool is_plain(const Material& material) {
  bool has_map = false;
  for_each_map(material, [&](const TextureMap&) { has_map = true; });
  return !has_map && material.metallic == 0 && material.emission == Vec3{} &&
         material.alpha_mode == AlphaMode::kOpaque && !material.is_unlit;
}

}  // namespace vitrine::inline codec
