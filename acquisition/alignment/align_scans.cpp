// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/align_scans.h"

#include <fmt/format.h>

#include <algorithm>

#include "acquisition/alignment/choose_pose.h"
#include "acquisition/alignment/joint_registration.h"
#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kMostScans = 16;

struct Edge {
  std::size_t from, to;
  PosesOfPair poses;
};

std::string names_of(std::span<const PoseScan> scans, const Edge& edge) {
  return fmt::format("{} and {}", scans[edge.from].name, scans[edge.to].name);
}

Expected<void> check(std::span<const PoseScan> scans) {
  if (scans.size() < 2 || scans.size() > kMostScans) {
    return fail(ErrorCode::kBadInput,
                fmt::format("there are {} scans; give 2 to {}", scans.size(), kMostScans));
  }
  for (const PoseScan& scan : scans) {
    if (!scan.mesh.faces.empty()) continue;
    return fail(ErrorCode::kBadInput, scan.name + " has no face; leave it out");
  }
  return {};
}

// Returns all pairs of scans, sorted by overlap, the largest overlap first.
std::vector<Edge> edges_of(const std::vector<PreparedScan>& scans,
                           const AlignmentOptions& options) {
  std::vector<Edge> edges;
  for (std::size_t from = 1; from < scans.size(); ++from) {
    for (std::size_t to = 0; to < from; ++to) {
      const auto fits = pair_fits(scans[from], scans[to], options.reach, options.seed);
      edges.push_back({from, to, choose_pose(fits, options.reach)});
    }
  }
  std::ranges::stable_sort(edges, std::greater{},
                           [](const Edge& edge) { return edge.poses.best.overlap; });
  return edges;
}

Unexpected not_joined(std::span<const PoseScan> scans, const std::vector<Edge>& edges,
                      const std::vector<bool>& is_joined) {
  const auto leaves = [&](const Edge& edge) { return is_joined[edge.from] != is_joined[edge.to]; };
  const auto ambiguous = std::ranges::find_if(edges, [&](const Edge& edge) {
    return leaves(edge) && edge.poses.verdict == PoseVerdict::kAmbiguous;
  });
  if (ambiguous != edges.end()) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{} fit together in more than one way: the object is symmetric, or "
                            "they share too little of it; scan one more pose that shows more of "
                            "the parts in both, or fix markers to the object and scan it again",
                            names_of(scans, *ambiguous)));
  }
  const auto edge = std::ranges::find_if(edges, leaves);
  return fail(ErrorCode::kBadInput,
              fmt::format("{} do not overlap enough to be aligned; scan one more pose between the "
                          "two, so that each scan shares half of its surface with another",
                          names_of(scans, *edge)));
}

// Chains the scans together, starting with the first scan. Each step adds a scan by the pair with
// the largest overlap. Returns each scan's motion into the frame of the first scan.
Expected<std::vector<RigidMotion>> join(std::span<const PoseScan> scans,
                                        const std::vector<Edge>& edges) {
  std::vector<RigidMotion> motions(scans.size());
  std::vector<bool> is_joined(scans.size());
  is_joined[0] = true;
  while (std::ranges::count(is_joined, false) > 0) {
    const auto edge = std::ranges::find_if(edges, [&](const Edge& e) {
      return is_joined[e.from] != is_joined[e.to] && e.poses.verdict == PoseVerdict::kAccepted;
    });
    if (edge == edges.end()) return not_joined(scans, edges, is_joined);
    const auto& [from, to, poses] = *edge;
    if (is_joined[to])
      motions[from] = then(poses.best.motion, motions[to]);
    else
      motions[to] = then(inverse(poses.best.motion), motions[from]);
    is_joined[from] = is_joined[to] = true;
  }
  return motions;
}

}  // namespace

Expected<Alignment> align_scans(std::span<const PoseScan> scans, const AlignmentOptions& options) {
  if (auto usable = check(scans); !usable) return tl::unexpected(usable.error());
  const double spacing = spacing_for(scans);
  std::vector<PreparedScan> prepared;
  for (const PoseScan& scan : scans)
    prepared.emplace_back(scan, spacing);
  auto motions = join(scans, edges_of(prepared, options));
  if (!motions) return tl::unexpected(motions.error());
  Alignment result{register_jointly(prepared, *motions, options.reach), {}};
  for (std::size_t from = 1; from < scans.size(); ++from) {
    for (std::size_t to = 0; to < from; ++to) {
      const RigidMotion motion = then(result.motions[from], inverse(result.motions[to]));
      const PairFit fit = judge_pair(prepared[from], prepared[to], motion, options.reach);
      if (is_contradicted(fit, options.reach)) {
        return fail(ErrorCode::kBadInput,
                    fmt::format("{} and {} contradict each other once all scans are aligned: one "
                                "would hide what the other has measured; scan one more pose "
                                "between the two, or leave one of them out",
                                scans[from].name, scans[to].name));
      }
      if (fit.overlap > 0)
        result.pairs.push_back({.from = from,
                                .to = to,
                                .overlap = fit.overlap,
                                .rms = fit.rms,
                                .crossed = fit.crossed});
    }
  }
  return result;
}

}  // namespace vitrine::acquisition
