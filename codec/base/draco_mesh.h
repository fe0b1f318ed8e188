// SPDX-License-Identifier: Apache-2.0
// Internal to codec/base: integer attributes out of a Draco buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/base_mesh.h"

namespace vitrine {

Expected<BaseMesh> decode_draco(std::span<const std::uint8_t> bytes);

}  // namespace vitrine
