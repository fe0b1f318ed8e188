// SPDX-License-Identifier: Apache-2.0
// Internal to codec/base: decodes a mesh with integer attributes from a Draco buffer.
#pragma once

#include <draco/attributes/geometry_attribute.h>

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {

// Returns the Draco attribute type that stores `semantic`.
inline draco::GeometryAttribute::Type draco_type(Semantic semantic) {
  switch (semantic) {
    case Semantic::kColour:
      break;
  }
  return draco::GeometryAttribute::COLOR;
}

Expected<BaseMesh> decode_draco(std::span<const std::uint8_t> bytes);

}  // namespace vitrine::inline codec
