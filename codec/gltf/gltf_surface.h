// SPDX-License-Identifier: Apache-2.0
// The colours of a glTF material, in metallic-roughness or specular-glossiness form.
#pragma once

#include <array>

#include "codec/core/vec.h"
#include "codec/gltf/gltf_json.h"

namespace vitrine::inline codec {

inline constexpr char kSpecularGlossiness[] = "KHR_materials_pbrSpecularGlossiness";

// The colours are in linear light. The references are to textureInfo objects of the document, or to
// JSON null.
struct GltfSurface {
  std::array<double, 4> colour;  // red, green, blue, opacity; each 0 to 1
  const Json& colour_texture;
  double metallic, roughness;  // 0 to 1
  const Json& metallic_roughness_texture;
  Vec3 emission;  // red, green, blue; may exceed 1
  const Json& emission_texture;

  // Whether the material only emits light: its colour is black and its emission is not. Some
  // exporters write unlit models in this way.
  bool only_emits() const;
};

// Returns the colours of a material. If the material has KHR_materials_pbrSpecularGlossiness, its
// diffuse colour becomes the base colour, and the material is not metallic.
GltfSurface surface_of(const Json& material);

}  // namespace vitrine::inline codec
