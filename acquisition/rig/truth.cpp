// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/truth.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "acquisition/rig_optics/local_optics.h"

namespace vitrine::acquisition::rig {
namespace {

// In mm. A ray starts this far from its vertex, so that it does not hit the vertex's own faces.
constexpr double kClearance = 0.02;

// Returns for each vertex the mean of its faces' normals, weighted by area. The mean is zero for a
// vertex without faces.
std::vector<Vec3> normals_of(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size());
  for (const Triangle& face : mesh.faces) {
    const Vec3& a = mesh.positions[face[0]];
    const Vec3 across = cross(mesh.positions[face[1]] - a, mesh.positions[face[2]] - a);
    for (const std::uint32_t v : face)
      normals[v] += across;
  }
  for (Vec3& normal : normals) {
    const double size = length(normal);
    if (size > 0) normal = normal * (1 / size);
  }
  return normals;
}

// Returns the table's angles, in degrees, at which `p` lies in the laser sheet. They are the
// solutions t of normal.y (x sin t + y cos t) = offset - normal.z z.
std::vector<double> crossings(const Optics& optics, const Vec3& p) {
  const LaserSheet& laser = optics.laser;
  const double radius = std::hypot(p.x, p.y);
  const double aside = (laser.offset - laser.normal.z * p.z) / laser.normal.y;
  if (radius <= std::abs(aside)) return {};
  const double azimuth = std::atan2(p.y, p.x), up = std::asin(aside / radius);
  const double sense = optics.is_clockwise ? -1 : 1;
  constexpr double kDegrees = 180 / std::numbers::pi;
  return {sense * (up - azimuth) * kDegrees, sense * (std::numbers::pi - up - azimuth) * kDegrees};
}

class Witness {
 public:
  Witness(const Solid& solid, const Optics& optics) : solid_(solid), optics_(optics) {}

  bool sees(const Vec3& p, const Vec3& normal) const {
    for (const double degrees : crossings(optics_, p)) {
      if (sees_at(degrees, p, normal)) return true;
    }
    return false;
  }

 private:
  bool sees_at(double degrees, const Vec3& p, const Vec3& normal) const {
    const LocalOptics optics = optics_in(on_table(optics_, degrees), optics_);
    const double to_camera = steepness(normal, optics.camera.at - p);
    const double to_laser = steepness(normal, optics.laser.source - p);
    if (to_camera * to_laser <= 0 || !within_picture(optics.camera, p)) return false;
    const double least = std::cos(kGrazing * std::numbers::pi / 180);
    if (std::abs(to_camera) < least || std::abs(to_laser) < least) return false;
    const Vec3 before = p + normal * (to_camera < 0 ? -kClearance : kClearance);
    return !solid_.blocked(before, optics.laser.source, 0) &&
           !solid_.blocked(before, optics.camera.at, 0);
  }

  static double steepness(const Vec3& normal, const Vec3& way) {
    return dot(normal, way) / length(way);
  }

  static bool within_picture(const Lens& camera, const Vec3& p) {
    const auto pixel = project(camera, p);
    return pixel && pixel->u >= 0 && pixel->u <= kSensorWidth - 1 && pixel->v >= 0 &&
           pixel->v <= kSensorHeight - 1;
  }

  const Solid& solid_;
  const Optics& optics_;
};

template <class T>
void put(std::vector<std::uint8_t>& out, T value) {
  static_assert(std::endian::native == std::endian::little);
  std::uint8_t bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

}  // namespace

std::vector<std::uint8_t> seen_vertices(const TriangleMesh& mesh, const Solid& solid,
                                        const Optics& optics) {
  const std::vector<Vec3> normals = normals_of(mesh);
  const Witness witness(solid, optics);
  std::vector<std::uint8_t> seen;
  seen.reserve(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    seen.push_back(witness.sees(mesh.positions[v], normals[v]) ? 1 : 0);
  return seen;
}

std::vector<std::uint8_t> truth_ply(const TriangleMesh& mesh,
                                    const std::vector<std::uint8_t>& seen) {
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment unit mm\nelement vertex {}\nproperty double "
      "x\nproperty double y\nproperty double z\nproperty uchar seen\nelement face {}\nproperty "
      "list uchar int vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.faces.size());
  std::vector<std::uint8_t> out(header.begin(), header.end());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    put(out, mesh.positions[v].x);
    put(out, mesh.positions[v].y);
    put(out, mesh.positions[v].z);
    put(out, seen[v]);
  }
  for (const Triangle& face : mesh.faces) {
    put(out, std::uint8_t{3});
    for (const std::uint32_t v : face)
      put(out, v);
  }
  return out;
}

}  // namespace vitrine::acquisition::rig
