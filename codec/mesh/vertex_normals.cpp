// SPDX-License-Identifier: Apache-2.0
#include "codec/mesh/vertex_normals.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vitrine::inline codec {
namespace {

auto coordinates_of(const Vec3& p) {
  return std::tuple(p.x, p.y, p.z);
}

// Returns, for each vertex, a representative vertex with the same position. Vertices with the same
// position have the same representative.
std::vector<std::uint32_t> same_positions(const std::vector<Vec3>& positions) {
  std::vector<std::uint32_t> order(positions.size()), same(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::uint32_t v) { return coordinates_of(positions[v]); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_first = i == 0 || positions[order[i]] != positions[order[i - 1]];
    same[order[i]] = is_first ? order[i] : same[order[i - 1]];
  }
  return same;
}

// Returns a vector along the face's normal. Its length is twice the face's area.
Vec3 area_vector(const TriangleMesh& mesh, const Triangle& f) {
  const Vec3& a = mesh.positions[f[0]];
  return cross(mesh.positions[f[1]] - a, mesh.positions[f[2]] - a);
}

}  // namespace

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size());
  for (const Triangle& f : mesh.faces) {
    const Vec3 n = area_vector(mesh, f);
    for (const std::uint32_t v : f)
      normals[v] += n;
  }
  return normals;
}

std::vector<Vec3> unit_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals = vertex_normals(mesh);
  for (Vec3& normal : normals) {
    const double size = length(normal);
    normal = size > 0 ? normal * (1 / size) : Vec3{0, 0, 1};
  }
  return normals;
}

std::vector<Vec3> position_normals(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> same = same_positions(mesh.positions);
  std::vector<Vec3> normals(mesh.positions.size());
  for (const Triangle& f : mesh.faces) {
    const Vec3 n = area_vector(mesh, f);
    for (const std::uint32_t v : f)
      normals[same[v]] += n;
  }
  for (std::size_t v = 0; v < normals.size(); ++v)
    normals[v] = normals[same[v]];
  return normals;
}

}  // namespace vitrine::inline codec
