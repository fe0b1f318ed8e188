// SPDX-License-Identifier: Apache-2.0
// The vertices of a mesh, projected to a picture.
#pragma once

#include "codec/render/framing.h"
#include "codec/render/screen_triangle.h"
#include "codec/render/shaded_mesh.h"

namespace vitrine::inline codec {

class ProjectedMesh {
 public:
  // Positions must be finite.
  ProjectedMesh(const ShadedMesh& model, const Framing& frame, const ViewAxes& axes);

  ScreenTriangle triangle(const Triangle& face) const {
    return ScreenTriangle({positions_[face[0]], positions_[face[1]], positions_[face[2]]});
  }
  // Returns the unit normal of a vertex in view space.
  const Vec3& normal(std::uint32_t vertex) const { return normals_[vertex]; }

 private:
  std::vector<Vec3> positions_, normals_;
};

}  // namespace vitrine::inline codec
