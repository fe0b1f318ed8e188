// SPDX-License-Identifier: Apache-2.0
// The `.pmesh` header, which describes a model and locates its base mesh and chunks. FORMAT.md
// specifies the byte layout.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/lattice.h"
#include "codec/core/limits.h"
#include "codec/core/sha256.h"
#include "codec/format/region_tree.h"
#include "codec/mesh/texturing.h"
#include "codec/mesh/vertex_attributes.h"

namespace vitrine::inline codec {

inline constexpr std::uint16_t kFormatMajor = 1;  // a reader refuses any other major version
inline constexpr std::uint16_t kFormatMinor = 0;

enum class Placement : std::uint8_t { kMidpoint = 0, kPyramid = 1 };

struct LevelInfo {
  std::uint32_t vertices = 0;  // vertices of the whole model at this level
  std::uint32_t faces = 0;     // faces of the whole model, without virtual faces
  // Distance between the displayed surface and the original surface in model units: an upper bound,
  // and the root mean square.
  double max_error = 0;
  double rms_error = 0;
  double display_filter = 0;  // strength of the display filter; 0 at full resolution
  std::uint32_t shift = 0;    // shift of the level's lattice (cell.h); 0 at full resolution
};

struct ChunkInfo {
  std::uint32_t level = 0;   // from 1; the chunk refines level - 1 to `level`
  std::uint32_t region = 0;  // number of the first leaf of the chunk's region
  std::uint32_t node = 0;    // index of the chunk's region in RegionTree::nodes
  std::uint64_t offset = 0;  // bytes from the start of the file
  std::uint64_t length = 0;
  std::uint32_t splits = 0;
  std::uint32_t inserted = 0;  // number of vertices in inserted components
  double max_error = 0;        // like LevelInfo::max_error, for this region at this level
  Sha256 sha256{};
};

// The kind of values that a picture of a texture shows. A point of the surface has the same place
// in the pictures of all roles.
enum class PictureRole : std::uint8_t {
  kBaseColour = 0,  // sRGB, and opacity unless the alpha mode is kOpaque
  kNormal = 1,      // normals in tangent space, as glTF has them
  kSurface = 2,     // occlusion (red), roughness (green), metallic (blue)
  kEmission = 3,    // emitted colours in sRGB
};
inline constexpr std::uint8_t kPictureRoles = 4;

// Returns the name of a role, as used in JSON and on the command line.
constexpr std::string_view name_of(PictureRole role) {
  constexpr std::array<std::string_view, kPictureRoles> kNames = {"base_colour", "normal",
                                                                  "surface", "emission"};
  return kNames[static_cast<std::size_t>(role)];
}

// A picture of the display atlas: a square WebP file.
struct PictureInfo {
  PictureRole role = PictureRole::kBaseColour;
  std::uint32_t side = 0;    // width and height in pixels
  std::uint64_t offset = 0;  // bytes from the start of the file
  std::uint64_t length = 0;
  Sha256 sha256{};
};

// Largest value of TextureInfo::side and of a texture coordinate.
inline constexpr std::uint32_t kMaxAtlasSide = 1u << 20;
inline constexpr std::uint32_t kMaxPictureSide = 16'384;
inline constexpr std::size_t kMaxPictures = 64;
// Maximum side, in pixels, of a picture in the head (Manifest::head_bytes()). Every viewer decodes
// the pictures in the head first.
inline constexpr std::uint32_t kMaxHeadPictureSide = 1'024;

// The texture of a model: a display atlas and its pictures. `side` is 0 if the model has none.
struct TextureInfo {
  std::uint32_t side = 0;  // width and height of the pictures, in units of texture coordinates
  // Position and size of the coded atlas of the base mesh (codec/coding/atlas_coder.h).
  std::uint64_t atlas_offset = 0, atlas_length = 0;
  Sha256 atlas_sha256{};
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  double alpha_cutoff = 0.5;
  bool is_double_sided = false, is_unlit = false;
  // The pictures in file order. The first `in_head` pictures follow the atlas; the others follow
  // the chunks.
  std::vector<PictureInfo> pictures;
  std::uint32_t in_head = 0;

  bool empty() const { return side == 0; }
  // Returns the size in bytes of the atlas and of all pictures.
  std::uint64_t bytes() const;
};

// The kinds of optional blocks. A reader skips blocks of all other kinds.
enum class OptionalKind : std::uint8_t {
  kSource = 0,         // the source's materials and texture coordinates
  kSourcePicture = 1,  // the bytes of a picture of the source
};

// A block at the end of a file that a reader does not need. `kind` may be any number.
struct OptionalBlock {
  std::uint64_t kind = 0;
  std::uint64_t offset = 0;  // bytes from the start of the file
  std::uint64_t length = 0;
  Sha256 sha256{};
};
inline constexpr std::size_t kMaxOptionalBlocks = 1'024;

// Returns the maximum number of vertices that a chunk of `length` bytes may add, by splits and by
// component insertions. The limit keeps a decoder's memory proportional to the bytes received. If a
// chunk is too short for its new vertices, the encoder appends zero bytes.
constexpr std::uint64_t most_new_vertices(std::uint64_t length) {
  return 16 * (length + 16);
}

struct Manifest {
  Lattice lattice;
  std::string unit = "";  // unit of the coordinates, such as "mm" or "m"; empty if unknown
  Placement placement = Placement::kMidpoint;
  PerSemantic<Semantic> attributes;  // the vertex attributes present, in ascending order
  bool has_insertions = false;       // whether chunks may insert small components
  // Number of boundary loops at full resolution. Without insertions, this number holds for every
  // level.
  std::uint32_t loops = 0;

  std::vector<LevelInfo> levels;  // levels[0] is the base mesh

  RegionTree tree;
  // Per leaf: the adjacent leaves in ascending order. Two leaves are adjacent if an edge of the
  // finest mesh joins them. Two regions are adjacent, in every level, if any of their leaves are
  // adjacent.
  std::vector<std::vector<std::uint32_t>> adjacency = {{}};

  // Position and size of the base mesh in the file, in bytes. The base mesh is a Draco buffer.
  std::uint64_t base_offset = 0, base_length = 0;
  Sha256 base_sha256{};
  TextureInfo texture;
  std::vector<ChunkInfo> chunks;               // in file order: by level, then by region
  std::vector<OptionalBlock> optional_blocks;  // in file order, at the end of the file
  std::uint64_t file_bytes = 0;

  bool has(Semantic semantic) const {
    return std::find(attributes.begin(), attributes.end(), semantic) != attributes.end();
  }
  const RegionNode& region(const ChunkInfo& chunk) const { return tree.nodes[chunk.node]; }
  // Returns the size in bytes of the head: the header, the base mesh, and the atlas and first
  // pictures of a texture.
  std::uint64_t head_bytes() const;
  // Returns the size in bytes of all chunks.
  std::uint64_t chunk_bytes() const {
    return file_bytes - base_offset - base_length - texture.bytes() - optional_bytes();
  }
  // Returns the size in bytes of all optional blocks.
  std::uint64_t optional_bytes() const;
  // Returns the size in bytes of the file up to and including the chunks of `level`.
  std::uint64_t cumulative_bytes(std::uint32_t level) const;
  // Returns the index in `chunks` of the chunk of `level` whose region contains `leaf`. Returns
  // chunks.size() if there is none.
  std::size_t find_chunk(std::uint32_t level, std::uint32_t leaf) const;
};

// header_bytes() returns the size of the header in bytes. `prefix` must hold at least the first
// kHeaderPrefix bytes of the file.
inline constexpr std::size_t kHeaderPrefix = 16;
Expected<std::uint64_t> header_bytes(std::span<const std::uint8_t> prefix);

// Parses a header and checks its hash. `bytes` may extend beyond the header. Safe on hostile bytes:
// every count is checked against `limits` and the remaining bytes before memory is allocated.
Expected<Manifest> parse_header(std::span<const std::uint8_t> bytes, const Limits& limits = {});

// Returns the bytes of the header. Also sets the offsets and `file_bytes` of `manifest`. The parts
// of the file follow each other without gaps, in this order: header, base mesh, atlas, pictures in
// the head, chunks, other pictures, optional blocks.
std::vector<std::uint8_t> write_header(Manifest& manifest);

}  // namespace vitrine::inline codec
