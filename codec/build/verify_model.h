// SPDX-License-Identifier: Apache-2.0
// Proves that a `.pmesh` is intact and, if the original is given, that it is lossless.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "codec/core/progress.h"
#include "codec/import/read_mesh.h"

namespace vitrine::inline codec {

// The mesh file from which a model was built, and the options with which it was read.
struct OriginalFile {
  std::span<const std::uint8_t> bytes;
  ReadOptions reading = {};
};

struct Verification {
  std::uint32_t levels = 0;
  std::uint64_t chunks = 0, vertices = 0, faces = 0;
  std::uint32_t orders = 0;  // number of refinement orders checked, including the order by level
  std::optional<bool> is_lossless;  // nullopt if no original was given
};

// Checks:
// - the size of the file and every SHA-256;
// - for each level: that its counts match the header, that the faces at the vertices of a region
//   lie in the region's box, that its stated error is at most the largest error stated for its
//   chunks, and that it is a manifold with boundary;
// - that full resolution has as many boundary loops as the header states;
// - that refinement in random orders reaches the same mesh, through states that are manifolds;
// - if `input` is given: that the finest level has the same set of faces as the repaired input
//   rounded to the lattice.
// Fails (kBadInput) at the first fault. A difference from `input` is not a fault; it sets
// `is_lossless` to false. Draco, which decodes the base mesh, is not safe on hostile bytes: call
// this in a sandbox for files from others.
Expected<Verification> verify_model(std::span<const std::uint8_t> pmesh,
                                    const std::optional<OriginalFile>& input,
                                    const ProgressReport& progress);

}  // namespace vitrine::inline codec
