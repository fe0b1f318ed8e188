// SPDX-License-Identifier: Apache-2.0
// Makes shapes with a known laser stripe, and computes the position of the stripe in a frame.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "acquisition/frame/frame.h"
#include "acquisition/rig_optics/renderer.h"
#include "acquisition/rig_optics/solid.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition::rig::test {

inline void add_quad(TriangleMesh& mesh, const Vec3& corner, const Vec3& a, const Vec3& b) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {corner, corner + a, corner + a + b, corner + b});
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.faces.push_back({first, first + 2, first + 3});
}

// Returns a square around `middle` whose normal has the direction `normal`.
inline TriangleMesh facet(const Vec3& middle, const Vec3& normal, double side) {
  const Vec3 level = cross({0, 0, 1}, normal), across = level * (side / length(level));
  const Vec3 slope = cross(normal, level), up = slope * (side / length(slope));
  TriangleMesh mesh;
  add_quad(mesh, middle - across * 0.5 - up * 0.5, across, up);
  return mesh;
}

// Returns an upright square through `middle` whose normal has the given azimuth.
inline TriangleMesh wall(const Vec3& middle, double azimuth_degrees, double side) {
  const double a = azimuth_degrees * std::numbers::pi / 180;
  return facet(middle, {std::cos(a), std::sin(a), 0}, side);
}

inline TriangleMesh ball(const Vec3& middle, double radius, std::uint32_t around) {
  TriangleMesh mesh;
  const std::uint32_t rows = around / 2;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around, e = std::numbers::pi * j / rows;
      mesh.positions.push_back(
          middle +
          Vec3{std::sin(e) * std::cos(a), std::sin(e) * std::sin(a), -std::cos(e)} * radius);
      if (j == rows) continue;
      const std::uint32_t right = j * around + (i + 1) % around, here = j * around + i;
      mesh.faces.push_back({here, right, right + around});
      mesh.faces.push_back({here, right + around, here + around});
    }
  }
  return mesh;
}

inline Solid matt(const TriangleMesh& mesh) {
  return Solid(mesh, {.is_painted = false, .gloss = 0});
}

inline Realism ideal() {
  return {.seed = 1, .is_ideal = true};
}

inline Setting at(double degrees, bool laser) {
  return {.degrees = degrees, .is_laser_on = laser};
}

// Returns the centre of mass of the laser's light in row `v` near column `u`, or nullopt if there
// is too little light.
inline std::optional<double> centre(const Frame& lit, const Frame& dark, int v, double u) {
  double sum = 0, moment = 0;
  const int middle = static_cast<int>(std::lround(u));
  for (int i = middle - 10; i <= middle + 10; ++i) {
    const double light = lit.row(v)[i] - dark.row(v)[i];
    sum += light;
    moment += light * i;
  }
  if (sum < 100) return std::nullopt;
  return moment / sum;
}

}  // namespace vitrine::acquisition::rig::test
