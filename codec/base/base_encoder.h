// SPDX-License-Identifier: Apache-2.0
// The base mesh as a Draco buffer (edgebreaker, integer attributes: lossless).
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/progressive/base_mesh.h"

namespace vitrine {

struct EncodedBase {
  std::vector<std::uint8_t> bytes;
  BaseMesh decoded;                     // as every reader of `bytes` will see it
  std::vector<std::uint32_t> original;  // per decoded vertex: its index in the input
};

// Draco chooses the order of the vertices; the decoded mesh shows it.
Expected<EncodedBase> encode_base(const BaseMesh& base);

}  // namespace vitrine
