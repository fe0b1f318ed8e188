// SPDX-License-Identifier: Apache-2.0
// Packs files into zip archives [ZIP] in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/export/write_mesh.h"

namespace vitrine::inline codec {

// Returns a zip archive of the files, in their order. The names of the files must be ASCII and may
// contain folders. Uses the fastest level of compression, because pictures are compressed already.
// Equal files give equal archives, because all entries have the same date. Fails (kLimit) if the
// archive or the files would exceed the 32-bit sizes of a zip.
Expected<std::vector<std::uint8_t>> zip(std::span<const MeshFile> files);

// Like zip(), but without compression. The bytes of each file begin at a multiple of 64 bytes from
// the start of the archive, as USDZ [USDZ] demands.
Expected<std::vector<std::uint8_t>> stored_zip(std::span<const MeshFile> files);

}  // namespace vitrine::inline codec
