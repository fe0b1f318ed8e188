// SPDX-License-Identifier: Apache-2.0
#include "codec/progressive/region_fork.h"

namespace vitrine {

std::uint16_t leaf_of(std::span<const RegionPlane> planes, const Vec3i& p) {
  std::size_t node = 0, regions = planes.size() + 1, first = 0;
  while (regions > 1) {
    const RegionPlane& plane = planes[node];
    const std::int32_t c = plane.axis == 0 ? p.x : plane.axis == 1 ? p.y : p.z;
    const std::size_t left = regions / 2;
    if (c < plane.at) {
      node += 1;
      regions = left;
    } else {
      node += left;
      first += left;
      regions -= left;
    }
  }
  return static_cast<std::uint16_t>(first);
}

void assign_regions(MeshState& mesh, std::span<const std::uint16_t> label, std::uint32_t regions) {
  const std::vector<VertexId> all = std::move(mesh.members[0]);
  mesh.members.assign(regions, {});
  for (const VertexId v : all) {
    mesh.region[v] = label[v];
    mesh.index[v] = static_cast<std::uint32_t>(mesh.members[label[v]].size());
    mesh.members[label[v]].push_back(v);
  }
  for (const VertexId v : all)
    mesh.mark_border(v);
}

}  // namespace vitrine
