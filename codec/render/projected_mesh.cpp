// SPDX-License-Identifier: Apache-2.0
#include "codec/render/projected_mesh.h"

#include "codec/render/canvas.h"
#include "codec/render/unit_vector.h"

namespace vitrine::inline codec {

ProjectedMesh::ProjectedMesh(const ShadedMesh& model, const Framing& frame, const ViewAxes& axes) {
  const double samples = kSamples / frame.pixel;  // samples per model unit
  positions_.reserve(model.mesh.positions.size());
  for (const Vec3& position : model.mesh.positions) {
    const Vec3 p = axes.to_view(position - frame.centre) * samples;
    positions_.push_back(
        {kSamples * frame.width / 2.0 + p.x, kSamples * frame.height / 2.0 - p.y, p.z});
  }
  normals_.reserve(model.normals.size());
  for (const Vec3& normal : model.normals)
    normals_.push_back(unit_vector(axes.to_view(normal)));
}

}  // namespace vitrine::inline codec
