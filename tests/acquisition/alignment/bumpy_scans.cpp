// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/bumpy_scans.h"

#include <algorithm>
#include <cmath>

#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {

double bumpy(const Vec3& d) {
  return 20 / std::sqrt(d.x * d.x / 1.2 + d.y * d.y / .8 + d.z * d.z) +
         1.5 * std::sin(3 * d.x + 2 * d.y) + std::cos(4 * d.z + d.x) +
         .8 * std::sin(9 * d.x - 4 * d.z) * std::cos(7 * d.y + 2 * d.x);
}

double vase(const Vec3& d) {
  return 20 + 4 * d.z + 1.5 * std::sin(12 * d.z);
}

double cube(const Vec3& d) {
  return 15 / std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
}

RigidMotion rotation_about(const Vec3& axis, double degrees, const Vec3& shift) {
  const Vec3 n = axis * (1 / length(axis));
  const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
  return {
      {Vec3{c + n.x * n.x * (1 - c), n.x * n.y * (1 - c) - n.z * s, n.x * n.z * (1 - c) + n.y * s},
       Vec3{n.y * n.x * (1 - c) + n.z * s, c + n.y * n.y * (1 - c), n.y * n.z * (1 - c) - n.x * s},
       Vec3{n.z * n.x * (1 - c) - n.y * s, n.z * n.y * (1 - c) + n.x * s, c + n.z * n.z * (1 - c)}},
      shift};
}

PoseScan scan_of(const Radius& radius, const RigidMotion& pose, double from,
                 const std::string& name) {
  PoseScan scan{name, {}, {}};
  constexpr std::uint32_t kAround = 200, kRows = 100;
  const RigidMotion back = inverse({pose.rows, {}});
  for (std::uint32_t j = 0; j < kRows; ++j) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const double z = .999 + (from - .999) * j / (kRows - 1), a = 2 * M_PI * i / kAround;
      const Vec3 d = {std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z};
      const Vec3 p = d * radius(back(d)) + pose.shift;
      scan.mesh.positions.push_back(p);
      if ((i + j) % 7 == 0) scan.lines.push_back({p, d});
    }
  }
  for (std::uint32_t j = 0; j + 1 < kRows; ++j) {
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      scan.mesh.faces.push_back({a, a + kAround, b});
      scan.mesh.faces.push_back({b, a + kAround, b + kAround});
    }
  }
  return scan;
}

}  // namespace vitrine::acquisition
