// SPDX-License-Identifier: Apache-2.0
#include "codec/distance/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "codec/distance/surface_sampler.h"
#include "codec/mesh/triangle_bvh.h"

namespace vitrine::inline codec {
namespace {

Expected<void> check(const TriangleMesh& mesh, const char* name) {
  if (mesh.faces.empty()) {
    return fail(ErrorCode::kBadInput,
                std::string("mesh ") + name + " has no face; give a mesh with a surface");
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (std::ranges::max(mesh.faces[f]) < mesh.positions.size()) continue;
    return fail(ErrorCode::kBadInput, std::string("mesh ") + name + ": face " + std::to_string(f) +
                                          " names a vertex that does not exist; export it again");
  }
  return {};
}

OneWayDistance one_way(const TriangleBvh& from, const TriangleBvh& to,
                       const MeasureOptions& options) {
  std::vector<double> squared;
  squared.reserve(options.samples);
  double sum = 0;
  std::uint32_t last = 0;
  for (const auto& [p, _] : sample_surface(from, options.samples, options.seed)) {
    const ClosestTriangle hit = to.closest(p, {squared_distance(to.triangle(last), p), last});
    last = hit.triangle;
    squared.push_back(hit.squared);
    sum += hit.squared;
  }
  if (squared.empty()) return {};
  const auto p95 = squared.begin() + static_cast<std::ptrdiff_t>((squared.size() - 1) * 19 / 20);
  std::nth_element(squared.begin(), p95, squared.end());
  return {.rms = std::sqrt(sum / static_cast<double>(squared.size())),
          .p95 = std::sqrt(*p95),
          .max = std::sqrt(*std::max_element(p95, squared.end()))};
}

double diagonal(const TriangleBvh::Node& n) {
  return length({static_cast<double>(n.high[0]) - n.low[0],
                 static_cast<double>(n.high[1]) - n.low[1],
                 static_cast<double>(n.high[2]) - n.low[2]});
}

}  // namespace

Expected<void> check_measurable(const TriangleMesh& a, const TriangleMesh& b) {
  return check(a, "A").and_then([&] { return check(b, "B"); });
}

Expected<SurfaceDistance> measure(const TriangleMesh& a, const TriangleMesh& b,
                                  const MeasureOptions& options) {
  if (auto ok = check_measurable(a, b); !ok) return tl::unexpected(ok.error());
  const TriangleBvh from(a), to(b);
  SurfaceDistance out{.a_to_b = one_way(from, to, options), .b_to_a = one_way(to, from, options)};
  out.rms = std::max(out.a_to_b.rms, out.b_to_a.rms);
  out.max = std::max(out.a_to_b.max, out.b_to_a.max);
  const double size = diagonal(to.nodes()[0]);
  if (size > 0) out.rms_percent = 100 * out.rms / size, out.max_percent = 100 * out.max / size;
  return out;
}

double rms_distance(const TriangleBvh& a, const TriangleBvh& b, const MeasureOptions& options) {
  return std::max(one_way(a, b, options).rms, one_way(b, a, options).rms);
}

}  // namespace vitrine::inline codec
