// SPDX-License-Identifier: Apache-2.0
#include "wedge_mesh.h"

#include <cmath>
#include <map>
#include <tuple>

#include "support/product_names.h"

namespace vitrine::bench {
namespace {

using Wedge = std::tuple<std::uint32_t, TextureCoordinates, std::uint16_t>;

void append(const Vec3& p, const Wedge& wedge, MeshoptInput& out) {
  for (const double x : {p.x, p.y, p.z})
    out.positions.push_back(static_cast<float>(x));
  const auto& [vertex, uv, material] = wedge;
  out.attributes.insert(out.attributes.end(), {uv[0], uv[1], static_cast<float>(material)});
}

}  // namespace

MeshoptInput wedge_mesh(const TriangleMesh& mesh, const Texturing& texturing) {
  MeshoptInput out{.attribute_count = kWedgeAttributes};
  std::map<Wedge, std::uint32_t> numbers;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Wedge wedge{mesh.faces[f][k], texturing.coordinates[0][f][k],
                        texturing.face_materials[f]};
      const auto [at, is_new] = numbers.emplace(wedge, static_cast<std::uint32_t>(numbers.size()));
      if (is_new) append(mesh.positions[mesh.faces[f][k]], wedge, out);
      out.indices.push_back(at->second);
    }
  }
  return out;
}

std::uint16_t material_of(const MeshoptInput& mesh, std::size_t face) {
  const std::size_t vertex = mesh.indices[3 * face];
  return static_cast<std::uint16_t>(std::lround(mesh.attributes[kWedgeAttributes * vertex + 2]));
}

}  // namespace vitrine::bench
