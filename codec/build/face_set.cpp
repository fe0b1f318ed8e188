// SPDX-License-Identifier: Apache-2.0
#include "codec/build/face_set.h"

#include <algorithm>
#include <bit>

namespace vitrine::inline codec {
namespace {

template <class Key>
Key smallest_rotation(const Key& key) {
  return std::min({key, Key{key[1], key[2], key[0]}, Key{key[2], key[0], key[1]}});
}

}  // namespace

std::vector<FaceKey> face_set(const LatticeMesh& mesh) {
  const auto corner = [&](std::uint32_t v) {
    return FaceCorner{mesh.positions[v], mesh.attributes.row(v)};
  };
  std::vector<FaceKey> faces;
  faces.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    faces.push_back(smallest_rotation(FaceKey{corner(a), corner(b), corner(c)}));
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

std::vector<TexturedFaceKey> textured_face_set(const Refiner& refiner) {
  std::vector<TexturedFaceKey> faces;
  const Wedges& wedges = refiner.wedges();
  if (wedges.empty()) return faces;
  const Connectivity& mesh = refiner.connectivity();
  const auto corner = [&](Corner c) {
    return TexturedCorner{refiner.positions()[mesh.vertex(c)], wedges[wedges.of(c)].at};
  };
  faces.reserve(refiner.face_count());
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (!mesh.is_real(f)) continue;
    faces.push_back(
        smallest_rotation(TexturedFaceKey{corner(3 * f), corner(3 * f + 1), corner(3 * f + 2)}));
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

std::vector<SourceFaceKey> source_face_set(const LatticeMesh& mesh, const Texturing& texturing) {
  const auto corner = [&](std::size_t f, std::size_t k) {
    SourceCorner out{mesh.positions[mesh.faces[f][k]]};
    for (std::size_t set = 0; set < kCoordinateSets; ++set) {
      if (texturing.coordinates[set].empty()) continue;
      for (std::size_t i = 0; i < 2; ++i)
        out.texture[2 * set + i] =
            std::bit_cast<std::uint32_t>(texturing.coordinates[set][f][k][i]);
    }
    return out;
  };
  std::vector<SourceFaceKey> faces;
  faces.reserve(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::array corners{corner(f, 0), corner(f, 1), corner(f, 2)};
    faces.push_back({smallest_rotation(corners), texturing.face_materials[f]});
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace vitrine::inline codec
