// SPDX-License-Identifier: Apache-2.0
// Decodes meshes from Draco buffers, which occur in .drc files and in compressed primitives of
// glTF.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/core/vec.h"

namespace draco {
class Mesh;
}

namespace vitrine::inline codec {

// Decodes a Draco buffer. First checks the counts in the Draco header against `limits` and against
// the size of the data (at most 1024 faces per byte). Draco itself is not safe on hostile bytes:
// call this in the sandbox. Fails (kBadInput, kUnsupported, kLimit).
Expected<std::unique_ptr<draco::Mesh>> decode_draco_data(std::span<const std::uint8_t> bytes,
                                                         const Limits& limits);

std::vector<Triangle> faces_of(const draco::Mesh& mesh);

}  // namespace vitrine::inline codec
