// SPDX-License-Identifier: Apache-2.0
// Decodes a base mesh with the Draco library, for a comparison with the codec's own reader.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "codec/format/base_mesh.h"

namespace vitrine::test {

// Returns nullopt if the library cannot decode `bytes`, or if they hold no mesh whose positions and
// attributes in `semantics` are integers. The library is not safe on hostile bytes.
std::optional<BaseMesh> library_base(std::span<const std::uint8_t> bytes,
                                     const PerSemantic<Semantic>& semantics);

}  // namespace vitrine::test
