// SPDX-License-Identifier: Apache-2.0
#include "acquisition/surface/surface_of.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "acquisition/surface/cloud.h"
#include "acquisition/surface/steps.h"
#include "acquisition/surface/strays.h"

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kFewestSteps = 3;  // fewer steps do not form a closed revolution
constexpr double kNeighbourhood = 4;     // points closer than this multiple of s_max are neighbours

std::vector<Profile> all_strands(std::span<const Profile> profiles) {
  std::vector<Profile> all;
  for (const Profile& profile : profiles)
    std::ranges::move(strands_of(profile), std::back_inserter(all));
  return all;
}

std::vector<Profile> without_strays(const Cloud& cloud, const Spacing& spacing,
                                    const SurfaceOptions& options, SurfaceReport& report) {
  const Strays strays =
      find_strays(cloud, kNeighbourhood * spacing.largest, options.smallest_piece);
  report.outliers = strays.outliers, report.isolated = strays.isolated;
  return keep(cloud, strays.kept);
}

std::vector<Profile> without_second_views(const Cloud& cloud, const Spacing& spacing,
                                          SurfaceReport& report) {
  const std::vector<bool> kept = first_views(cloud, 2 * spacing.largest);
  report.seen_twice = static_cast<std::uint64_t>(std::ranges::count(kept, false));
  return keep(cloud, kept);
}

void sample_all(std::vector<Profile>& strands, const SamplingOptions& options,
                SurfaceReport& report) {
  sample(strands, options);
  for (const Profile& strand : strands)
    report.sampled += strand.points.size();
}

void drop_unused(TriangleMesh& mesh) {
  constexpr std::uint32_t kUnused = 0xFFFF'FFFF;
  std::vector<std::uint32_t> number(mesh.positions.size(), kUnused);
  for (const Triangle& face : mesh.faces) {
    for (const std::uint32_t v : face)
      number[v] = 0;
  }
  std::uint32_t used = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kUnused) continue;
    mesh.positions[used] = mesh.positions[v];
    number[v] = used++;
  }
  mesh.positions.resize(used);
  for (Triangle& face : mesh.faces) {
    for (std::uint32_t& v : face)
      v = number[v];
  }
}

TriangleMesh mesh_of(const Cloud& cloud, const Spacing& spacing) {
  TriangleMesh mesh{cloud.positions, {}, {}};
  mesh.faces.reserve(2 * cloud.size());
  for (std::size_t step = 0; step < cloud.step_count(); ++step)
    add_strips(cloud, step, spacing, mesh.faces);
  return mesh;
}

}  // namespace

Expected<ScannedSurface> surface_of(std::span<const Profile> profiles,
                                    const SurfaceOptions& options) {
  ScannedSurface surface;
  SurfaceReport& report = surface.report;
  Cloud cloud(all_strands(profiles));
  report.points = cloud.size();
  if (cloud.step_count() < kFewestSteps)
    return fail(
        ErrorCode::kBadInput,
        fmt::format("{} profiles do not make a surface; scan at least {} steps of a revolution",
                    cloud.step_count(), kFewestSteps));
  const Spacing spacing = spacing_of(cloud, options);
  report.spacing = spacing.largest;
  cloud = Cloud(without_strays(cloud, spacing, options, report));
  cloud = Cloud(without_second_views(cloud, spacing, report));
  for (Profile& strand : cloud.strands)
    report.filled += fill_gaps(strand, options.largest_hole, spacing);
  report.smoothed = smooth(cloud.strands, options.noise, spacing);
  sample_all(cloud.strands, options.sampling, report);
  surface.mesh = mesh_of(Cloud(std::move(cloud.strands)), spacing);
  report.holes = close_holes(surface.mesh, options.largest_hole);
  drop_unused(surface.mesh);
  if (surface.mesh.faces.empty())
    return fail(ErrorCode::kBadInput,
                fmt::format("no surface: of {} points {} are outliers and {} isolated, and no "
                            "neighbouring profiles join; scan with more steps or a higher exposure",
                            report.points, report.outliers, report.isolated));
  return surface;
}

}  // namespace vitrine::acquisition
