// SPDX-License-Identifier: Apache-2.0
#include "codec/build/charts.h"

#include "codec/mesh/disjoint_sets.h"

namespace vitrine::inline codec {

// All wedges of a face belong to the same chart. Faces share wedges across every edge that is not a
// seam. Uniting the wedges of each face therefore yields the charts.
std::vector<WedgeId> charts_of(const Refiner& refiner) {
  const Connectivity& mesh = refiner.connectivity();
  const Wedges& wedges = refiner.wedges();
  DisjointSets sets(wedges.size());
  for (std::uint32_t f = 0; f < mesh.face_count() && !wedges.empty(); ++f) {
    if (!mesh.is_real(f)) continue;
    for (const Corner c : {3 * f + 1, 3 * f + 2})
      sets.join(wedges.of(3 * f), wedges.of(c));
  }
  std::vector<WedgeId> charts;
  for (WedgeId w = 0; w < wedges.size(); ++w)
    charts.push_back(sets.find(w));
  return charts;
}

std::uint32_t chart_count(const Refiner& refiner) {
  const std::vector<WedgeId> charts = charts_of(refiner);
  std::uint32_t count = 0;
  for (WedgeId w = 0; w < charts.size(); ++w)
    count += charts[w] == w ? 1 : 0;
  return count;
}

}  // namespace vitrine::inline codec
