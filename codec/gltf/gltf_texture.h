// SPDX-License-Identifier: Apache-2.0
// A material's reference to a texture in a glTF document.
#pragma once

#include <cstdint>
#include <optional>

#include "codec/gltf/gltf_json.h"
#include "codec/mesh/texturing.h"

namespace vitrine::inline codec {

struct GltfTexture {
  std::uint64_t image = kAbsent;  // index of the image; may be out of range
  std::uint64_t texcoord = 0;     // n in the attribute name TEXCOORD_n
  bool is_nearest = false;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  TextureTransform transform;
};

// Reads a textureInfo object, including the texture, the sampler and KHR_texture_transform. Returns
// nullopt if it refers to no texture.
std::optional<GltfTexture> read_texture(const Json& document, const Json& reference);

}  // namespace vitrine::inline codec
