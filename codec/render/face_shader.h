// SPDX-License-Identifier: Apache-2.0
// Computes the colour of a face at any of its samples from base colour, normal and light.
//
// The base colour is the vertex colour times the material's factor and map. A mesh without vertex
// colours gets the colour of stone, unless a material has a colour or a colour map. The surface is
// matt: metallic, roughness, occlusion and emission have no effect.
#pragma once

#include <optional>

#include "codec/render/canvas.h"
#include "codec/render/light.h"
#include "codec/render/projected_mesh.h"

namespace vitrine::inline codec {

class FaceShader {
 public:
  // All references must outlive this object.
  FaceShader(const ShadedMesh& model, const ProjectedMesh& projected, const Light& light,
             std::uint32_t face);

  // Returns the light that reaches the eye from a sample inside the face, in linear light.
  Vec3 at(SamplePosition at) const;

 private:
  Vec3 base_colour(const Barycentric& weights) const;
  Vec3 normal(const Barycentric& weights) const;
  Vec3 bent(const Vec3& normal, const Texel& texel) const;

  const Light& light_;
  ScreenTriangle triangle_;
  std::array<Vec3, 3> normals_, colours_;  // one per corner
  const Material* material_ = nullptr;     // null if the mesh has no materials
  std::optional<FaceTexture> colour_map_, normal_map_;
};

}  // namespace vitrine::inline codec
