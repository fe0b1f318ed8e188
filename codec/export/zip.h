// SPDX-License-Identifier: Apache-2.0
// Packs files into a zip archive in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/export/write_mesh.h"

namespace vitrine::inline codec {

// Returns a zip archive of the files, in their order. Their names may have folders. Compresses
// fast, because pictures are compressed already. Equal files give equal bytes: no entry has a time.
// Fails (kIo) if the archive cannot be written.
Expected<std::vector<std::uint8_t>> zip(std::span<const MeshFile> files);

}  // namespace vitrine::inline codec
