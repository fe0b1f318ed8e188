// SPDX-License-Identifier: Apache-2.0
#include "error_curves.h"

#include <cmath>

#include "single_files.h"
#include "subject.h"
#include "support/product_names.h"

namespace vitrine::bench {

ErrorCurves error_curves(std::span<const std::uint8_t> pmesh, const TriangleMesh& original) {
  ErrorCurves out;
  for (const Level& level : decode_levels(pmesh)) {
    const double error = rms_percent(level.mesh, original);
    out.by_faces.push_back({static_cast<double>(level.mesh.faces.size()), error});
    out.by_bytes.push_back({static_cast<double>(level.bytes), error});
  }
  return out;
}

double error_at(const std::vector<ErrorPoint>& levels, double x) {
  std::size_t i = 1;
  while (i + 1 < levels.size() && levels[i].x < x)
    ++i;
  const ErrorPoint &a = levels[i - 1], &b = levels[i];
  const double t = std::log(x / a.x) / std::log(b.x / a.x);
  return a.error * std::pow(b.error / a.error, t);
}

}  // namespace vitrine::bench
