// SPDX-License-Identifier: Apache-2.0
// Merges several scans of one object, placed differently on the table, into one mesh.
#pragma once

#include <span>

#include "codec/core/expected.h"
#include "codec/distance/rigid_alignment.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::acquisition {

struct MergeOptions {
  // Surfaces closer than this, in mm, count as the same surface.
  double overlap = .5;
};

struct Merged {
  TriangleMesh mesh;                 // mm, in the frame of the first scan; without colours
  std::vector<RigidMotion> motions;  // the motion that registers each scan; identity for the first
  // Rms distance, in mm, of each scan to the earlier scans where they overlap.
  std::vector<double> rms;
  // Share of each scan's points that overlap earlier scans. 1 for the first scan.
  std::vector<double> shares;
};

// Returns whether scan k may be misregistered: fewer than a fifth of its points overlap, or their
// rms distance exceeds 0.4 of `overlap`. For surfaces that merely intersect, the rms is about 0.58
// of `overlap`.
bool is_doubtful(const Merged& merged, std::size_t k, const MergeOptions& options);

// Registers each scan to the earlier scans and merges them. Registration uses iterated closest
// points ([BM92], point to plane [CM92]) over the overlap without rims. `starts` has one rough
// placement for each scan, from the operator, correct to a few mm and degrees. Each part of the
// surface comes from the first scan that saw it: a face of a later scan is dropped if its corners
// and centre lie closer than `overlap` to the earlier scans. Limits: the registration error is not
// distributed over all scans, because each moves once. Overlapping measurements are not averaged.
// The seam stays open, and sheets overlap there by up to a face's width. Fails with kBadInput if a
// scan has no face, the number of starts differs, or a scan does not overlap with the earlier ones.
Expected<Merged> merge(std::span<const TriangleMesh> scans, std::span<const RigidMotion> starts,
                       const MergeOptions& options = {});

}  // namespace vitrine::acquisition
