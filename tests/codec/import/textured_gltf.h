// SPDX-License-Identifier: Apache-2.0
// A small textured glTF file for tests.
#pragma once

#include "codec/import/glb_builder.h"
#include "codec/picture/pictures.h"

namespace vitrine::testing {

// Returns one triangle. Its corners are at u = 0.25, 0.75 and 1.25 of `picture`.
inline GlbBuilder textured(const std::string& picture) {
  GlbBuilder builder;
  const std::size_t points = builder.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  const std::size_t places = builder.floats("VEC2", {0.25, 0, 0.75, 0, 1.25, 0}, 3);
  builder.append("images", {{"bufferView", builder.view(picture)}, {"mimeType", "image/png"}});
  builder.append("samplers", GlbBuilder::Json::object());
  builder.append("textures", {{"source", 0}, {"sampler", 0}});
  builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  builder.mesh({{"attributes", {{"POSITION", points}, {"TEXCOORD_0", places}}}, {"material", 0}});
  return builder;
}

}  // namespace vitrine::testing
