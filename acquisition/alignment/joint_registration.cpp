// SPDX-License-Identifier: Apache-2.0
#include "acquisition/alignment/joint_registration.h"

#include "acquisition/alignment/rigid_pose.h"

namespace vitrine::acquisition {
namespace {

constexpr int kSweeps = 10;

// Returns pairs of points between scan k and each other scan, in the frame of the first scan.
std::vector<Counterpart> pairs_of(std::span<const PreparedScan> scans,
                                  const std::vector<RigidMotion>& motions, std::size_t k,
                                  double reach) {
  std::vector<Counterpart> all;
  for (std::size_t other = 0; other < scans.size(); ++other) {
    if (other == k) continue;
    const RigidMotion into = then(motions[k], inverse(motions[other]));
    for (const Counterpart& pair :
         scans[other].surface().counterparts(scans[k].vertices(), into, reach)) {
      all.push_back({motions[other](pair.point), motions[other](pair.on),
                     turned(motions[other], pair.normal)});
    }
  }
  return all;
}

double rms_of_all(std::span<const PreparedScan> scans, const std::vector<RigidMotion>& motions,
                  double reach) {
  std::vector<Counterpart> all;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const auto pairs = pairs_of(scans, motions, k, reach);
    all.insert(all.end(), pairs.begin(), pairs.end());
  }
  return rms_of(all);
}

}  // namespace

std::vector<RigidMotion> register_jointly(std::span<const PreparedScan> scans,
                                          const std::vector<RigidMotion>& motions, double reach) {
  std::vector<RigidMotion> joint = motions;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t k = 1; k < scans.size(); ++k)
      joint[k] = then(joint[k], towards_planes(pairs_of(scans, joint, k, reach)));
  }
  return rms_of_all(scans, joint, reach) < rms_of_all(scans, motions, reach) ? joint : motions;
}

}  // namespace vitrine::acquisition
