// SPDX-License-Identifier: Apache-2.0
// Encodes the base mesh as a Draco buffer [Draco], without loss. Uses the edgebreaker method and
// integer attributes.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {

struct EncodedBase {
  std::vector<std::uint8_t> bytes;
  BaseMesh decoded;                     // the result of decoding `bytes`
  std::vector<std::uint32_t> original;  // for each vertex of `decoded`, its index in the input mesh
};

// Encodes `base`. Draco reorders the vertices; `decoded` has the new order. Fails (kBadInput) if
// Draco refuses the mesh or changes its surface.
Expected<EncodedBase> encode_base(const BaseMesh& base);

}  // namespace vitrine::inline codec
