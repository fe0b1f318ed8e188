// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_optics/plate.h"

#include <cmath>
#include <numbers>

namespace vitrine::acquisition::rig {
namespace {

constexpr double kRadius = 60;  // in mm; larger than any object
constexpr std::uint32_t kCorners = 90;

}  // namespace

TriangleMesh plate() {
  TriangleMesh mesh;
  mesh.positions.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const double a = 2 * std::numbers::pi * i / kCorners;
    mesh.positions.push_back({kRadius * std::cos(a), kRadius * std::sin(a), 0});
    mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % kCorners});
  }
  return mesh;
}

}  // namespace vitrine::acquisition::rig
