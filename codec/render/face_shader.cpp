// SPDX-License-Identifier: Apache-2.0
#include "codec/render/face_shader.h"

#include <algorithm>

#include "codec/render/unit_vector.h"

namespace vitrine::inline codec {
namespace {

Vec3 vertex_colour(const ShadedMesh& model, std::uint32_t vertex) {
  static const Vec3 stone = linear_light({0xd8, 0xd3, 0xcb});
  const auto& colours = model.mesh.attributes.colours;
  if (!colours.empty()) return linear_light(colours[vertex]);
  return model.textures == nullptr || model.textures->are_white() ? stone : Vec3{1, 1, 1};
}

Vec3 product(const Vec3& a, const Vec3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

// Returns the edge from corner 0 to `corner` in view space, where y points up.
Vec3 edge(const ScreenTriangle& triangle, std::size_t corner) {
  const Vec3 e = triangle.corners()[corner] - triangle.corners()[0];
  return {e.x, -e.y, e.z};
}

}  // namespace

FaceShader::FaceShader(const ShadedMesh& model, const ProjectedMesh& projected, const Light& light,
                       std::uint32_t face)
    : light_(light), triangle_(projected.triangle(model.mesh.faces[face])) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t vertex = model.mesh.faces[face][i];
    normals_[i] = projected.normal(vertex);
    colours_[i] = vertex_colour(model, vertex);
  }
  if (model.textures == nullptr) return;
  material_ = &model.textures->material(face);
  colour_map_ = model.textures->map(&Material::base_colour_map, face, triangle_);
  normal_map_ = model.textures->map(&Material::normal_map, face, triangle_);
}

Vec3 FaceShader::base_colour(const Barycentric& weights) const {
  Vec3 colour = mix(colours_, weights);
  if (material_ == nullptr) return colour;
  const auto& factor = material_->base_colour;
  colour = product(colour, {factor[0], factor[1], factor[2]});
  if (!colour_map_) return colour;
  const Texel map = colour_map_->at(weights);
  return product(colour, {map[0], map[1], map[2]});
}

// Applies a normal map to a unit normal. The tangents are computed from the texture coordinates of
// the face, so the mesh need not store tangents ([Schueler06]).
Vec3 FaceShader::bent(const Vec3& normal, const Texel& texel) const {
  const auto& uv = normal_map_->corners();
  const Vec3 across_ac = cross(edge(triangle_, 2), normal);
  const Vec3 across_ab = cross(normal, edge(triangle_, 1));
  const Vec3 u = across_ac * (uv[1][0] - uv[0][0]) + across_ab * (uv[2][0] - uv[0][0]);
  const Vec3 v = across_ac * (uv[1][1] - uv[0][1]) + across_ab * (uv[2][1] - uv[0][1]);
  const double longest = std::sqrt(std::max(dot(u, u), dot(v, v)));
  const double scale = longest > 0 ? material_->normal_scale / longest : 0;
  // v increases downwards in the picture, but green points up.
  return u * (scale * (2 * texel[0] - 1)) - v * (scale * (2 * texel[1] - 1)) +
         normal * (2 * texel[2] - 1);
}

Vec3 FaceShader::normal(const Barycentric& weights) const {
  const Vec3 smooth = unit_vector(mix(normals_, weights));
  return normal_map_ ? unit_vector(bent(smooth, normal_map_->at(weights))) : smooth;
}

Vec3 FaceShader::at(SamplePosition at) const {
  const Barycentric weights = triangle_.at(at.x, at.y);
  const Vec3 colour = base_colour(weights);
  if (material_ != nullptr && material_->is_unlit) return colour;
  const Vec3 outward = normal(weights);
  return product(colour, light_.on(triangle_.is_front() ? outward : outward * -1));
}

}  // namespace vitrine::inline codec
