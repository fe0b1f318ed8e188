// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/vec.h"
#include "codec/import/edge_groups.h"

namespace vitrine {

struct Reversal {
  std::uint64_t faces = 0;
  std::uint64_t first_face = 0;
};

// Turns the faces of each patch (faces joined by edges of exactly two faces) the way that most of
// them run. Nothing changes where neighbours agree already. `groups` are the edges of `faces`; they
// are stale where a face was reversed.
Reversal orient_patches(std::span<Triangle> faces, const EdgeGroups& groups);

}  // namespace vitrine
