// SPDX-License-Identifier: Apache-2.0
#include "codec/gltf/gltf_instances.h"

#include <cmath>
#include <string>

#include "codec/gltf/gltf_document.h"

namespace vitrine::inline codec {
namespace {

Vec3 vector_at(const std::optional<Accessor>& values, std::uint64_t i, const Vec3& otherwise) {
  if (!values) return otherwise;
  return {values->real(i, 0), values->real(i, 1), values->real(i, 2)};
}

// Returns a unit quaternion. Its components in the file may be integers that are not marked as
// normalised.
std::array<double, 4> rotation_at(const std::optional<Accessor>& values, std::uint64_t i) {
  std::array<double, 4> q{0, 0, 0, 1};
  if (!values) return q;
  double square = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    q[k] = values->real(i, k);
    square += q[k] * q[k];
  }
  for (double& part : q)
    part /= square > 0 ? std::sqrt(square) : 1;
  return q;
}

}  // namespace

Expected<GltfInstances> GltfInstances::open(const Json& document, GltfBuffer& buffer,
                                            std::uint64_t node) {
  GltfInstances out;
  const Json& attributes =
      member(extension(element(document, "nodes", node), "EXT_mesh_gpu_instancing"), "attributes");
  const auto add = [&](const char* name, std::uint32_t width,
                       std::optional<Accessor>& to) -> Expected<void> {
    const std::uint64_t index = whole(attributes, name, kAbsent);
    if (index == kAbsent) return {};
    const auto opened = Accessor::open(document, buffer, index);
    if (!opened) return tl::unexpected(opened.error());
    if (opened->width() != width || opened->count() != out.count_.value_or(opened->count()))
      return bad_gltf("the instances of node " + std::to_string(node) + " do not match");
    out.count_ = opened->count();
    to = *opened;
    return {};
  };
  if (auto ok = add("TRANSLATION", 3, out.translation_); !ok) return tl::unexpected(ok.error());
  if (auto ok = add("ROTATION", 4, out.rotation_); !ok) return tl::unexpected(ok.error());
  if (auto ok = add("SCALE", 3, out.scale_); !ok) return tl::unexpected(ok.error());
  return out;
}

Affine GltfInstances::operator[](std::uint64_t i) const {
  return compose(vector_at(translation_, i, {0, 0, 0}), rotation_at(rotation_, i),
                 vector_at(scale_, i, {1, 1, 1}));
}

}  // namespace vitrine::inline codec
