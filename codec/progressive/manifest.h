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
  std::uint32_t region = 0;  // 0 while the level has one region
  std::uint64_t offset = 0;  // from the start of the file
  std::uint64_t length = 0;
  std::uint32_t splits = 0;
  Sha256 sha256{};
};

// A chunk of `length` bytes holds at most this many splits, so that what a decoder allocates is
// bounded by what it was sent. An encoder that does better appends zero bytes.
constexpr std::uint64_t most_splits(std::uint64_t length) {
  return 16 * (length + 16);
}

// A plane of the region tree: vertices with coordinate[axis] < at go to the first child.
struct RegionPlane {
  std::uint8_t axis = 0;  // 0 x, 1 y, 2 z
  std::int32_t at = 0;    // lattice units
};

struct Manifest {
  Lattice lattice;
  std::string unit = "";  // of the model's coordinates: "mm", "m", … or empty where unknown
  Placement placement = Placement::kMidpoint;
  bool coloured = false;
  std::uint32_t loops = 0;  // boundary loops, the same at every level

  std::vector<LevelInfo> levels;  // [0] is the base mesh

  std::uint32_t regions = 1;  // leaves of the region tree
  std::uint32_t fork_level =
      0;  // the first level whose chunks are per region (levels.size() if none)
  std::vector<RegionPlane> planes;                    // regions - 1, in pre-order
  std::vector<std::vector<std::uint32_t>> adjacency;  // per region, ascending, without itself

  std::uint64_t base_offset = 0, base_length = 0;  // the base mesh: a Draco buffer
  Sha256 base_sha256{};
  std::vector<ChunkInfo> chunks;  // in file order: by level, then region
  std::uint64_t file_bytes = 0;

  std::uint32_t regions_at(std::uint32_t level) const { return level < fork_level ? 1 : regions; }
  std::uint64_t head_bytes() const { return base_offset + base_length; }  // header and base
  // Bytes of the file up to and including `level`.
  std::uint64_t cumulative_bytes(std::uint32_t level) const;
  // Index into `chunks`, or chunks.size() where there is none.
  std::size_t find_chunk(std::uint32_t level, std::uint32_t region) const;
};

// The number of bytes the header occupies, read from its first kHeaderPrefix bytes.
inline constexpr std::size_t kHeaderPrefix = 16;
Expected<std::uint64_t> header_bytes(std::span<const std::uint8_t> prefix) noexcept;

// Parses a header. Safe on hostile bytes: every count is checked against the bytes left and
// `limits` before memory is reserved. `bytes` may go on beyond the header.
Expected<Manifest> parse_header(std::span<const std::uint8_t> bytes,
                                const Limits& limits = {}) noexcept;

// Writes the header. Offsets, lengths and file_bytes are laid out here (header, base, chunks
// without gaps) and stored back into `manifest`.
std::vector<std::uint8_t> write_header(Manifest& manifest);

}  // namespace vitrine
