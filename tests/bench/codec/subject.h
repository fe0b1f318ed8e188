// SPDX-License-Identifier: Apache-2.0
// Wraps each stage of the codec in one function. These functions throw on errors, because a
// benchmark of a broken codec has no results.
#pragma once

#include "codec/format/manifest.h"
#include "codec/simplify/simplify.h"
#include "peers.h"
#include "support/product_names.h"

namespace vitrine::bench {

// Reads and repairs a mesh file. The other libraries get the repaired mesh too.
TriangleMesh read_clean(std::span<const std::uint8_t> file);

// Builds the `.pmesh` of a mesh file on one thread.
Bytes build(std::span<const std::uint8_t> file, int bits,
            Placement placement = Placement::kMidpoint,
            CollapseOrder order = CollapseOrder::kBatch);
// Builds the `.pmesh` on the given number of threads.
Bytes build_on(std::span<const std::uint8_t> file, int bits, unsigned threads);
// Builds the `.pmesh` without regions.
Bytes build_in_one_region(std::span<const std::uint8_t> file, int bits);

// Checks and decodes every chunk. Returns the number of faces at full resolution.
std::uint32_t decode(std::span<const std::uint8_t> pmesh);

// A level of detail: a prefix of the file, decoded.
struct Level {
  std::uint64_t bytes = 0;  // length of the prefix
  TriangleMesh mesh;        // displayed mesh
};
std::vector<Level> decode_levels(std::span<const std::uint8_t> pmesh);

}  // namespace vitrine::bench
