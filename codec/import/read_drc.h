// SPDX-License-Identifier: Apache-2.0
// Reads a .drc file, which read_mesh() does not: no scanner writes them.
#pragma once

#include <cstdint>
#include <span>

#include "codec/core/expected.h"
#include "codec/core/limits.h"
#include "codec/mesh/triangle_mesh.h"

namespace vitrine {

bool is_drc(std::span<const std::uint8_t> bytes);

// Positions and faces; colours are left out. Draco is not safe on hostile bytes: call it in the
// sandbox. Fails (kBadInput, kUnsupported, kLimit).
Expected<TriangleMesh> read_drc(std::span<const std::uint8_t> bytes, const Limits& limits = {});

}  // namespace vitrine
