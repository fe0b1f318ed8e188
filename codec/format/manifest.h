// SPDX-License-Identifier: Apache-2.0
// The `.pmesh` header, which describes a model and locates its base mesh and chunks. FORMAT.md
// specifies the byte layout.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/lattice.h"
#include "codec/core/limits.h"
#include "codec/core/sha256.h"
#include "codec/format/region_tree.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

inline constexpr std::uint16_t kFormatMajor = 1;  // a reader refuses any other major version
inline constexpr std::uint16_t kFormatMinor = 0;

enum class Placement : std::uint8_t { kMidpoint = 0, kPyramid = 1 };

struct LevelInfo {
  std::uint32_t vertices = 0;  // vertices of the whole model at this level
  std::uint32_t faces = 0;     // faces of the whole model, without those that close boundary loops
  // Distance between the displayed and the original surface in model units: an upper bound, and the
  // root mean square.
  double max_error = 0;
  double rms_error = 0;
  double display_filter = 0;  // parameter `a` of the display filter; 0 at full resolution
  std::uint32_t shift = 0;    // shift of the level's lattice (cell.h); 0 at full resolution
};

struct ChunkInfo {
  std::uint32_t level = 0;   // from 1; the chunk refines level - 1 to this level
  std::uint32_t region = 0;  // number of the first leaf of the chunk's region
  std::uint32_t node = 0;    // index of the chunk's region in RegionTree::nodes
  std::uint64_t offset = 0;  // bytes from the start of the file
  std::uint64_t length = 0;
  std::uint32_t splits = 0;
  std::uint32_t inserted = 0;  // number of vertices in inserted components
  double max_error = 0;  // like LevelInfo::max_error, for this region after the chunk is applied
  Sha256 sha256{};
};

// Returns the maximum number of vertices that a chunk of `length` bytes may add, by splits and by
// component insertions. The limit bounds a decoder's memory by the bytes received. An encoder whose
// chunk would be shorter appends zero bytes.
constexpr std::uint64_t most_new_vertices(std::uint64_t length) {
  return 16 * (length + 16);
}

struct Manifest {
  Lattice lattice;
  std::string unit = "";  // unit of the coordinates, such as "mm" or "m"; empty if unknown
  Placement placement = Placement::kMidpoint;
  PerSemantic<Semantic> attributes;  // vertex attributes in ascending order
  bool has_insertions = false;       // whether chunks may insert small components
  // Number of boundary loops at full resolution. Without insertions, every level has this number.
  std::uint32_t loops = 0;

  std::vector<LevelInfo> levels;  // levels[0] is the base mesh

  RegionTree tree;
  // For each leaf, the adjacent leaves in ascending order. Two leaves are adjacent if an edge of
  // the finest mesh joins them. In every level, two regions are adjacent if any of their leaves
  // are.
  std::vector<std::vector<std::uint32_t>> adjacency = {{}};

  // Position and size in bytes of the base mesh, a Draco buffer.
  std::uint64_t base_offset = 0, base_length = 0;
  Sha256 base_sha256{};
  std::vector<ChunkInfo> chunks;  // in file order: by level, then by region
  std::uint64_t file_bytes = 0;

  bool has(Semantic semantic) const {
    return std::find(attributes.begin(), attributes.end(), semantic) != attributes.end();
  }
  const RegionNode& region(const ChunkInfo& chunk) const { return tree.nodes[chunk.node]; }
  // Returns the size of the header and the base mesh in bytes.
  std::uint64_t head_bytes() const { return base_offset + base_length; }
  // Returns the size in bytes of the file up to and including the chunks of `level`.
  std::uint64_t cumulative_bytes(std::uint32_t level) const;
  // Returns the index in `chunks` of the chunk of `level` whose region contains `leaf`, or
  // chunks.size() if there is none.
  std::size_t find_chunk(std::uint32_t level, std::uint32_t leaf) const;
};

// header_bytes() returns the size of the header in bytes. `prefix` holds at least the first
// kHeaderPrefix bytes of the file.
inline constexpr std::size_t kHeaderPrefix = 16;
Expected<std::uint64_t> header_bytes(std::span<const std::uint8_t> prefix);

// Parses a header and checks its hash. Safe on hostile bytes: every count is checked against
// `limits` and the remaining bytes before memory is allocated. `bytes` may extend beyond the
// header.
Expected<Manifest> parse_header(std::span<const std::uint8_t> bytes, const Limits& limits = {});

// Returns the bytes of the header. Also sets the offsets and `file_bytes` of `manifest`, for a file
// in which header, base mesh and chunks follow each other without gaps.
std::vector<std::uint8_t> write_header(Manifest& manifest);

}  // namespace vitrine::inline codec
