// SPDX-License-Identifier: Apache-2.0
// Reads a .drc file. read_mesh() does not read these files, because no scanner writes them.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine::inline codec {

bool is_drc(std::span<const std::uint8_t> bytes);

// Reads positions and faces, but no colours. Draco is not safe on hostile bytes: call this in the
// sandbox. Fails (kBadInput, kUnsupported, kLimit).
Expected<TriangleMesh> read_drc(std::span<const std::uint8_t> bytes, const Limits& limits = {});

}  // namespace vitrine::inline codec
