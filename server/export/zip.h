// SPDX-License-Identifier: Apache-2.0
// Packs files into a zip archive in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/export/write_mesh.h"

namespace vitrine::server {

// Returns a zip archive of the files, in their order. Uses fast compression, because pictures are
// already compressed. Equal files give equal archives, because entries have no time stamps. Fails
// (kIo) if the archive cannot be written.
Expected<std::vector<std::uint8_t>> zip(std::span<const MeshFile> files);

}  // namespace vitrine::server
