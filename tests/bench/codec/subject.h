// SPDX-License-Identifier: Apache-2.0
// The codec under measurement, each stage behind one function. Faults throw: a benchmark of
// something broken has no figures.
#pragma once

#include "codec/progressive/manifest.h"
#include "codec/simplify/simplify.h"
#include "peers.h"

namespace vitrine::bench {

// Reads and cleans a mesh file: what the peers are given.
TriangleMesh read_clean(std::span<const std::uint8_t> file);

// The `.pmesh` of a mesh file, one thread.
Bytes build(std::span<const std::uint8_t> file, int bits,
            Placement placement = Placement::kMidpoint,
            CollapseOrder order = CollapseOrder::kBatch);
// The same without regions.
Bytes build_in_one_region(std::span<const std::uint8_t> file, int bits);

// Checks and decodes every chunk; the number of faces at full resolution.
std::uint32_t decode(std::span<const std::uint8_t> pmesh);

// What a prefix of the file shows.
struct Level {
  std::uint64_t bytes = 0;  // of the prefix
  TriangleMesh mesh;        // as displayed
};
std::vector<Level> decode_levels(std::span<const std::uint8_t> pmesh);

}  // namespace vitrine::bench
