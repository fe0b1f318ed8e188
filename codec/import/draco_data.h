// SPDX-License-Identifier: Apache-2.0
// Meshes in Draco's own buffers: a .drc file, a compressed primitive of a GLB.
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

namespace vitrine {

// The counts in the Draco header are compared with the limits and with the data's size before Draco
// sees it (at most 1024 faces a byte); but Draco itself is not safe on hostile bytes, so this
// belongs into the sandbox. Fails (kBadInput, kUnsupported, kLimit).
Expected<std::unique_ptr<draco::Mesh>> decode_draco_data(std::span<const std::uint8_t> bytes,
                                                         const Limits& limits);

std::vector<Triangle> faces_of(const draco::Mesh& mesh);

}  // namespace vitrine
