// SPDX-License-Identifier: Apache-2.0
// The `.pmesh` header: everything about a model except its surface. FORMAT.md is the byte layout.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/lattice.h"
#include "codec/core/limits.h"
#include "codec/core/sha256.h"
#include "codec/progressive/region_tree.h"

namespace vitrine {

inline constexpr std::uint16_t kFormatMajor = 1;  // a reader refuses another major version
inline constexpr std::uint16_t kFormatMinor = 0;

enum class Placement : std::uint8_t { kMidpoint = 0, kPyramid = 1 };

struct LevelInfo {
  std::uint32_t vertices = 0;  // real vertices of the whole model at this level
  std::uint32_t faces = 0;     // real faces
  double max_error = 0;        // model units; a true bound of the displayed surface's distance
  double rms_error = 0;        // model units
  double display_filter = 0;   // `a` of the display filter, 0 at full resolution
  std::uint32_t shift = 0;     // of the level's lattice (cell.h), 0 at full resolution
};

struct ChunkInfo {
  std::uint32_t level = 0;   // 1..levels-1: turns level-1 into level
  std::uint32_t region = 0;  // of the level: named by its first leaf
  std::uint32_t node = 0;    // the same, as a node of the region tree
  std::uint64_t offset = 0;  // from the start of the file
  std::uint64_t length = 0;
  std::uint32_t splits = 0;
  std::uint32_t newborn = 0;  // vertices of components that are born whole
  double max_error = 0;       // as of the level, of what the region then displays
  Sha256 sha256{};
};

// A chunk of `length` bytes brings at most this many vertices, by splits and in components that are
// born whole, so that what a decoder allocates is bounded by what it was sent. An encoder that does
// better appends zero bytes.
constexpr std::uint64_t most_born(std::uint64_t length) {
  return 16 * (length + 16);
}

struct Manifest {
  Lattice lattice;
  std::string unit = "";  // of the model's coordinates: "mm", "m", … or empty where unknown
  Placement placement = Placement::kMidpoint;
  bool coloured = false;
  bool births = false;      // small components are born whole in chunks
  std::uint32_t loops = 0;  // boundary loops at full resolution; without births at every level

  std::vector<LevelInfo> levels;  // [0] is the base mesh

  RegionTree tree;
  // Per leaf: the leaves that an edge of the finest mesh joins to it; ascending. Regions are
  // neighbours where leaves of theirs are, in every level.
  std::vector<std::vector<std::uint32_t>> adjacency = {{}};

  std::uint64_t base_offset = 0, base_length = 0;  // the base mesh: a Draco buffer
  Sha256 base_sha256{};
  std::vector<ChunkInfo> chunks;  // in file order: by level, then region
  std::uint64_t file_bytes = 0;

  const RegionNode& region(const ChunkInfo& chunk) const { return tree.nodes[chunk.node]; }
  std::uint64_t head_bytes() const { return base_offset + base_length; }  // header and base
  // Bytes of the file up to and including `level`.
  std::uint64_t cumulative_bytes(std::uint32_t level) const;
  // The chunk of a level whose region holds a leaf: index into `chunks`, or chunks.size() where
  // there is none.
  std::size_t find_chunk(std::uint32_t level, std::uint32_t leaf) const;
};

// The number of bytes the header occupies, read from its first kHeaderPrefix bytes.
inline constexpr std::size_t kHeaderPrefix = 16;
Expected<std::uint64_t> header_bytes(std::span<const std::uint8_t> prefix);

// Parses a header whose hash is right. Safe on hostile bytes: every count is checked against the
// bytes left and `limits` before memory is reserved. `bytes` may go on beyond the header.
Expected<Manifest> parse_header(std::span<const std::uint8_t> bytes, const Limits& limits = {});

// Writes the header. Offsets, lengths and file_bytes are laid out here (header, base, chunks
// without gaps) and stored back into `manifest`.
std::vector<std::uint8_t> write_header(Manifest& manifest);

}  // namespace vitrine
