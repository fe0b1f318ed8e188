// SPDX-License-Identifier: Apache-2.0
// Chooses the levels of a file or a tileset that holds several levels of detail, and decodes them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/build/refine.h"
#include "codec/export/coarser_level.h"

namespace vitrine::inline codec {

// Returns the coarser levels to offer besides a mesh with `faces` faces, from fine to coarse. Each
// is the finest level with at most a quarter of the faces of the previous one. The last is the base
// mesh. Returns an empty list if the base mesh has `faces` faces or more. `finest` is the finest
// level that may be chosen.
std::vector<std::uint32_t> coarser_levels(const Manifest& manifest, std::uint32_t finest,
                                          std::uint64_t faces);

// Decodes the levels that coarser_levels() returns. `refiner` must be at level 0. If `is_textured`,
// the levels have texture coordinates and no colours. Fails with the error of `read` or of
// Refiner::apply().
Expected<std::vector<CoarserLevel>> decode_levels(Refiner refiner,
                                                  std::span<const std::uint32_t> levels,
                                                  bool is_textured, const ChunkReader& read);

}  // namespace vitrine::inline codec
