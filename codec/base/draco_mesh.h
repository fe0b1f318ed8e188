// SPDX-License-Identifier: Apache-2.0
// Internal to codec/base: integer attributes out of a Draco buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/base_mesh.h"

namespace vitrine {

struct DracoMesh {
  BaseMesh mesh;
  std::vector<std::int32_t> numbers;  // of a generic attribute with one component, or empty
};

Expected<DracoMesh> decode_draco(std::span<const std::uint8_t> bytes);

}  // namespace vitrine
