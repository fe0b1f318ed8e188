// SPDX-License-Identifier: Apache-2.0
// Packs files into a zip archive [ZIP] as USDZ [USDZ] demands: without compression, and aligned.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/export/write_mesh.h"

namespace vitrine::inline codec {

// Returns a zip archive of the files, in their order. The bytes of each file begin at a multiple of
// 64 bytes from the start of the archive, so that readers can map them into memory. Equal files
// give equal bytes. Fails (kLimit) if the archive would exceed the 32-bit sizes of a zip.
Expected<std::vector<std::uint8_t>> stored_zip(std::span<const MeshFile> files);

}  // namespace vitrine::inline codec
