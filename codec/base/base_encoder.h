// SPDX-License-Identifier: Apache-2.0
// Encodes the base mesh without loss as a Draco buffer [Draco], with the edgebreaker method and
// integer attributes.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/core/expected.h"
#include "codec/format/base_mesh.h"

namespace vitrine::inline codec {

struct EncodedBase {
  std::vector<std::uint8_t> bytes;
  BaseMesh decoded;                     // the mesh that a reader of `bytes` gets
  std::vector<std::uint32_t> original;  // per decoded vertex: its index in the input mesh
};

// Encodes `base`. Draco reorders the vertices; `decoded` has the new order. Fails (kBadInput) if
// Draco refuses the mesh or changes its surface.
Expected<EncodedBase> encode_base(const BaseMesh& base);

}  // namespace vitrine::inline codec
