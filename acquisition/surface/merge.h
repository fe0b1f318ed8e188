// SPDX-License-Identifier: Apache-2.0
// Several scans of one object, which lay differently on the table, as one mesh.
#pragma once

#include <span>

#include "codec/core/expected.h"
#include "codec/mesh/rigid_alignment.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

struct MergeOptions {
  double overlap = .5;  // mm: surfaces closer than this show the same
};

struct Merged {
  TriangleMesh mesh;                 // in the frame of the first scan, mm; without colours
  std::vector<RigidMotion> motions;  // of each scan; that of the first is none
  std::vector<double> rms;           // mm: of each scan to those before it where they overlap
  std::vector<double> shares;        // of each scan's points, that overlap; of the first 1
};

// Whether scan k may well lie where it does by chance: it overlaps in less than a fifth of its
// points, or their distances are spread as evenly over `overlap` as those of surfaces that cross
// each other (rms .58 of it).
bool is_doubtful(const Merged& merged, std::size_t k, const MergeOptions& options);

// What is done: from `starts` (one a scan, the operator's: correct within the object's features,
// some mm and degrees) each scan is moved onto those before it by iterated closest points over the
// part that overlaps and is not at a rim (point to plane). Of a later scan the faces are dropped
// whose three corners and middle lie closer than `overlap` to the earlier ones; the others are
// added, with their vertices alone. So each
// place is shown by the first scan that saw it.
// What is not done: the error of registration is not spread over all scans (each is moved once),
// overlapping measurements are not averaged, and the seam is not closed: along it sheets overlap
// by up to a face's width. Fails (kBadInput) where a scan has no face, the starts are not as many,
// or a scan does not overlap with those before it.
Expected<Merged> merge(std::span<const TriangleMesh> scans, std::span<const RigidMotion> starts,
                       const MergeOptions& options = {});

}  // namespace vitrine
