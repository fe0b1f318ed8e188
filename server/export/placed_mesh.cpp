// SPDX-License-Identifier: Apache-2.0
#include "server/export/placed_mesh.h"

namespace vitrine::server {

void place(TriangleMesh& mesh, const PresentationTransform& placement) {
  if (placement.is_identity()) return;
  for (Vec3& position : mesh.positions)
    position = placement(position);
}

void place(CoarserLevel& level, const PresentationTransform& placement) {
  place(level.mesh, placement);
  level.error *= placement.scale();
  level.grid = placed(level.grid, placement);
}

ExportGrid placed(const ExportGrid& grid, const PresentationTransform& placement) {
  return {placement(grid.origin), grid.step * placement.scale()};
}

}  // namespace vitrine::server
