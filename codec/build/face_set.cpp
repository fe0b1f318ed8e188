// SPDX-License-Identifier: Apache-2.0
#include "codec/build/face_set.h"

#include <algorithm>

namespace vitrine::inline codec {
namespace {

FaceKey smallest_rotation(const FaceKey& key) {
  return std::min({key, FaceKey{key[1], key[2], key[0]}, FaceKey{key[2], key[0], key[1]}});
}

}  // namespace

std::vector<FaceKey> face_set(const LatticeMesh& mesh) {
  const auto corner = [&](std::uint32_t v) {
    return FaceCorner{mesh.positions[v], mesh.attributes.row(v)};
  };
  std::vector<FaceKey> faces;
  faces.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    faces.push_back(smallest_rotation({corner(a), corner(b), corner(c)}));
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace vitrine::inline codec
