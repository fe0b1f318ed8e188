// SPDX-License-Identifier: Apache-2.0
#include "codec/format/manifest.h"

#include <algorithm>
#include <cmath>

#include "codec/core/byte_cursor.h"
#include "codec/core/fill_in.h"
#include "codec/format/cell.h"
#include "codec/format/signature.h"

namespace vitrine::inline codec {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'P', 'M', 'E', 'S', 'H', 0x0D, 0x0A};

// Feature flags. A reader refuses a file that sets a flag that the reader does not know.
constexpr std::uint64_t kFeaturePyramid = 1u << 0;
constexpr std::uint64_t kFeatureColours = 1u << 1;
constexpr std::uint64_t kFeatureInsertions = 1u << 2;
constexpr std::uint64_t kFeatureTexture = 1u << 3;
constexpr std::uint64_t kFeatureOptional = 1u << 5;
constexpr std::uint64_t kKnownFeatures =
    kFeaturePyramid | kFeatureColours | kFeatureInsertions | kFeatureTexture | kFeatureOptional;

constexpr double kMostStep = 1e30;  // keeps displayed positions within the range of floats
constexpr std::size_t kMaxUnitBytes = 16;
constexpr std::size_t kHashBytes = 32;
constexpr std::size_t kLevelBytes = 2 + 3 * 4 + 1;     // minimum size of a level record
constexpr std::size_t kChunkBytes = 2 + kHashBytes;    // minimum size of a chunk record
constexpr std::size_t kPictureBytes = 3 + kHashBytes;  // minimum size of a picture record
constexpr std::size_t kBlockBytes = 2 + kHashBytes;    // minimum size of an optional block's record

// Properties of a textured surface, as bits of one byte.
constexpr std::uint8_t kDoubleSided = 1u << 0, kUnlit = 1u << 1;

Unexpected bad(const char* what, std::initializer_list<std::uint64_t> numbers = {}) {
  return fail(ErrorCode::kBadInput,
              join({"damaged .pmesh header: ", fill_in(what, numbers), "; fetch the file again"}));
}

// Rounds up to single precision. An upper bound therefore remains an upper bound.
float round_up(double v) {
  const float f = static_cast<float>(v);
  return static_cast<double>(f) < v ? std::nextafter(f, 3e38f) : f;
}

void write_float(ByteWriter& out, float v) {
  out.u32(std::bit_cast<std::uint32_t>(v));
}
double read_float(ByteReader& in) {
  return std::bit_cast<float>(in.u32());
}

bool is_sane_error(double v) {
  return v >= 0 && v < 1e30;
}

void write_levels(ByteWriter& out, const Manifest& m) {
  out.varint(m.levels.size());
  for (const LevelInfo& level : m.levels) {
    out.varint(level.vertices);
    out.varint(level.faces);
    write_float(out, round_up(level.max_error));
    write_float(out, static_cast<float>(level.rms_error));
    write_float(out, static_cast<float>(level.display_filter));
    out.u8(static_cast<std::uint8_t>(level.shift));
  }
}

// Checks that vertex counts, face counts and lattices are consistent from level to level.
Expected<void> check_levels(const Manifest& m) {
  const LevelInfo& base = m.levels.front();
  if (base.vertices < 3 || base.faces == 0) {
    return bad("the base mesh has {} vertices and {} faces, fewer than one triangle",
               {base.vertices, base.faces});
  }
  if (base.shift > kMaxShift) return bad("the lattice of a level is impossible");
  for (std::size_t l = 1; l < m.levels.size(); ++l) {
    const LevelInfo &fine = m.levels[l], &coarse = m.levels[l - 1];
    if (fine.vertices < coarse.vertices) return bad("levels lose vertices");
    if (fine.shift > coarse.shift) return bad("a finer level has a coarser lattice");
    // A split adds one vertex and two faces, or only one face at a boundary. An inserted component
    // has at least one face per three vertices.
    const std::uint64_t added = fine.vertices - coarse.vertices;
    const std::uint64_t least = m.has_insertions ? (added + 2) / 3 : added;
    if (fine.faces < coarse.faces + least || fine.faces > coarse.faces + 2 * added) {
      return bad("the faces of level {} do not fit its vertices", {l});
    }
  }
  return {};
}

Expected<void> read_levels(ByteReader& in, const Limits& limits, Manifest& m) {
  const std::uint64_t count = in.varint();
  if (!in.is_ok() || count == 0 || count > limits.levels || count > in.left() / kLevelBytes) {
    return bad("impossible number of levels ({})", {count});
  }
  m.levels.resize(count);
  for (LevelInfo& level : m.levels) {
    const std::uint64_t vertices = in.varint(), faces = in.varint();
    if (vertices > limits.vertices || faces > limits.faces) {
      return fail(
          ErrorCode::kLimit,
          "the model has more vertices or faces than this reader allows; ask for a smaller one");
    }
    level.vertices = static_cast<std::uint32_t>(vertices);
    level.faces = static_cast<std::uint32_t>(faces);
    level.max_error = read_float(in);
    level.rms_error = read_float(in);
    level.display_filter = read_float(in);
    level.shift = in.u8();
    if (!is_sane_error(level.max_error) || !is_sane_error(level.rms_error) ||
        !(level.display_filter >= 0 && level.display_filter <= 1)) {
      return bad("a level's error or display filter is out of range");
    }
  }
  return check_levels(m);
}

void write_regions(ByteWriter& out, const Manifest& m) {
  for (const RegionNode& node : m.tree.nodes) {
    out.varint(node.fork);
    for (const Vec3i& corner : {node.box.low, node.box.high}) {
      for (const std::int32_t c : {corner.x, corner.y, corner.z})
        out.signed_varint(c);
    }
    if (node.fork == 0) continue;
    out.u8(node.plane.axis);
    out.signed_varint(node.plane.at);
  }
  if (m.tree.leaves() == 1) return;
  for (const auto& neighbours : m.adjacency) {
    out.varint(neighbours.size());
    std::uint32_t last = 0;
    for (std::uint32_t n : neighbours)
      out.varint(n - last), last = n;
  }
}

bool read_plane(ByteReader& in, RegionPlane& plane) {
  plane.axis = in.u8();
  const std::int64_t at = in.signed_varint();
  plane.at = static_cast<std::int32_t>(at);
  return plane.axis <= 2 && at >= -(1 << 20) && at <= (1 << 20);
}

Expected<void> read_adjacency(ByteReader& in, Manifest& m) {
  const std::uint32_t leaves = m.tree.leaves();
  m.adjacency.assign(leaves, {});
  if (leaves == 1) return {};
  for (std::uint32_t k = 0; k < leaves; ++k) {
    const std::uint64_t count = in.varint();
    if (count >= leaves || count > in.left()) return bad("impossible region adjacency");
    std::uint64_t id = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t step = in.varint();
      id += step;
      if ((i > 0 && step == 0) || step >= leaves || id >= leaves || id == k) {
        return bad("impossible region adjacency");
      }
      m.adjacency[k].push_back(static_cast<std::uint32_t>(id));
    }
  }
  for (std::uint32_t k = 0; k < leaves; ++k) {
    for (std::uint32_t n : m.adjacency[k]) {
      if (!std::binary_search(m.adjacency[n].begin(), m.adjacency[n].end(), k)) {
        return bad("region adjacency is not symmetric");
      }
    }
  }
  return {};
}

bool read_box(ByteReader& in, LatticeBox& box) {
  bool sane = true;
  for (Vec3i* corner : {&box.low, &box.high}) {
    for (std::int32_t* c : {&corner->x, &corner->y, &corner->z}) {
      const std::int64_t value = in.signed_varint();
      sane = sane && value >= -(1 << 18) && value <= (1 << 18);
      *c = static_cast<std::int32_t>(value);
    }
  }
  return sane && box.holds(box.low);
}

Expected<void> read_regions(ByteReader& in, const Limits& limits, Manifest& m) {
  m.tree.nodes.clear();
  // `leaves` is 1 + the number of forks read so far. `missing` is the number of nodes still to be
  // read.
  std::uint64_t leaves = 1, missing = 1;
  while (missing > 0) {
    RegionNode node;
    const std::uint64_t fork = in.varint();
    if (!in.is_ok()) return bad("it ends inside the region tree");
    // A region cannot fork at level 1: the child regions are coded at the end of the previous
    // level's chunk, and level 0 has no chunks.
    if (fork == 1 || fork > limits.levels) return bad("a region forks at an impossible level");
    node.fork = static_cast<std::uint32_t>(fork);
    if (!read_box(in, node.box)) return bad("impossible box of a region");
    if (fork == 0) {
      --missing;
    } else {
      if (++leaves > limits.regions) return bad("impossible number of regions");
      if (!read_plane(in, node.plane)) return bad("impossible region plane");
      ++missing;
    }
    m.tree.nodes.push_back(node);
  }
  if (!m.tree.link()) return bad("a region forks before the one that it is part of");
  return read_adjacency(in, m);
}

void write_texture(ByteWriter& out, const TextureInfo& texture) {
  if (texture.empty()) return;
  out.varint(texture.side);
  out.varint(texture.atlas_length);
  out.bytes(texture.atlas_sha256);
  out.u8(static_cast<std::uint8_t>(texture.alpha_mode));
  write_float(out, static_cast<float>(texture.alpha_cutoff));
  out.u8((texture.is_double_sided ? kDoubleSided : 0) | (texture.is_unlit ? kUnlit : 0));
  out.varint(texture.pictures.size());
  out.varint(texture.in_head);
  for (const PictureInfo& picture : texture.pictures) {
    out.u8(static_cast<std::uint8_t>(picture.role));
    out.varint(picture.side);
    out.varint(picture.length);
    out.bytes(picture.sha256);
  }
}

// Sets the offsets of the atlas and of the pictures in the head. Returns the end of the head as an
// offset in the file.
std::uint64_t place_head(Manifest& m) {
  TextureInfo& texture = m.texture;
  std::uint64_t offset = m.base_offset + m.base_length;
  texture.atlas_offset = offset;
  offset += texture.atlas_length;
  for (std::uint32_t i = 0; i < texture.in_head; ++i)
    texture.pictures[i].offset = offset, offset += texture.pictures[i].length;
  return offset;
}

// Sets the offsets of the pictures after the chunks and of the optional blocks, and the size of the
// file.
void place_tail(Manifest& m) {
  for (std::size_t i = m.texture.in_head; i < m.texture.pictures.size(); ++i) {
    PictureInfo& picture = m.texture.pictures[i];
    picture.offset = m.file_bytes;
    m.file_bytes += picture.length;
  }
  for (OptionalBlock& block : m.optional_blocks) {
    block.offset = m.file_bytes;
    m.file_bytes += block.length;
  }
}

bool read_hash(ByteReader& in, Sha256& hash) {
  const auto digest = in.bytes(kHashBytes);
  std::copy(digest.begin(), digest.end(), hash.begin());
  return in.is_ok();
}

Expected<void> read_picture(ByteReader& in, PictureInfo& picture) {
  const std::uint8_t role = in.u8();
  const std::uint64_t side = in.varint();
  picture.length = in.varint();
  if (!read_hash(in, picture.sha256) || role >= kPictureRoles || side == 0 ||
      side > kMaxPictureSide || picture.length > (1ull << 40)) {
    return bad("impossible picture of a texture");
  }
  picture.role = static_cast<PictureRole>(role);
  picture.side = static_cast<std::uint32_t>(side);
  return {};
}

Expected<void> read_texture(ByteReader& in, TextureInfo& texture) {
  const std::uint64_t side = in.varint();
  texture.atlas_length = in.varint();
  const bool has_hash = read_hash(in, texture.atlas_sha256);
  const std::uint8_t alpha_mode = in.u8();
  texture.alpha_cutoff = read_float(in);
  const std::uint8_t properties = in.u8();
  const std::uint64_t count = in.varint(), in_head = in.varint();
  if (!has_hash || side == 0 || side > kMaxAtlasSide || texture.atlas_length > (1ull << 40)) {
    return bad("impossible atlas of a texture");
  }
  if (alpha_mode > static_cast<std::uint8_t>(AlphaMode::kBlend) ||
      !(texture.alpha_cutoff >= 0 && texture.alpha_cutoff <= 1) ||
      properties > (kDoubleSided | kUnlit)) {
    return bad("impossible properties of a textured surface");
  }
  if (!in.is_ok() || count > kMaxPictures || in_head > count || in_head > kPictureRoles ||
      count > in.left() / kPictureBytes) {
    return bad("impossible number of pictures ({})", {count});
  }
  texture.side = static_cast<std::uint32_t>(side);
  texture.alpha_mode = static_cast<AlphaMode>(alpha_mode);
  texture.is_double_sided = (properties & kDoubleSided) != 0;
  texture.is_unlit = (properties & kUnlit) != 0;
  texture.in_head = static_cast<std::uint32_t>(in_head);
  texture.pictures.resize(count);
  for (PictureInfo& picture : texture.pictures) {
    if (auto ok = read_picture(in, picture); !ok) return ok;
  }
  const auto head = std::span(texture.pictures).first(in_head);
  const auto is_large = [](const PictureInfo& p) { return p.side > kMaxHeadPictureSide; };
  if (std::any_of(head.begin(), head.end(), is_large))
    return bad("a picture of the head is too large");
  return {};
}

void write_optional_blocks(ByteWriter& out, const Manifest& m) {
  if (m.optional_blocks.empty()) return;
  out.varint(m.optional_blocks.size());
  for (const OptionalBlock& block : m.optional_blocks) {
    out.varint(block.kind);
    out.varint(block.length);
    out.bytes(block.sha256);
  }
}

Expected<void> read_optional_blocks(ByteReader& in, Manifest& m) {
  const std::uint64_t count = in.varint();
  if (count == 0 || count > kMaxOptionalBlocks || count > in.left() / kBlockBytes)
    return bad("impossible number of optional blocks ({})", {count});
  m.optional_blocks.resize(count);
  for (OptionalBlock& block : m.optional_blocks) {
    block.kind = in.varint();
    block.length = in.varint();
    if (!read_hash(in, block.sha256) || block.length > (1ull << 40))
      return bad("impossible optional block");
  }
  return {};
}

void write_chunks(ByteWriter& out, const Manifest& m) {
  for (const ChunkInfo& chunk : m.chunks) {
    out.varint(chunk.length);
    out.varint(chunk.splits);
    if (m.has_insertions) out.varint(chunk.inserted);
    if (m.tree.leaves() > 1) write_float(out, round_up(chunk.max_error));
    out.bytes(chunk.sha256);
  }
}

Expected<void> read_level_chunks(ByteReader& in, std::uint32_t level, Manifest& m) {
  const std::vector<std::uint32_t> regions = m.tree.regions_at(level);
  if (regions.size() > in.left() / kChunkBytes) return bad("it ends inside the chunk index");
  const std::uint64_t added = m.levels[level].vertices - m.levels[level - 1].vertices;
  std::uint64_t sum = 0;
  for (const std::uint32_t node : regions) {
    ChunkInfo chunk{.level = level, .region = m.tree.nodes[node].first, .node = node};
    chunk.offset = m.file_bytes;
    chunk.length = in.varint();
    const std::uint64_t splits = in.varint();
    const std::uint64_t inserted = m.has_insertions ? in.varint() : 0;
    chunk.max_error = m.tree.leaves() > 1 ? read_float(in) : m.levels[level].max_error;
    const auto digest = in.bytes(kHashBytes);
    if (!in.is_ok() || !is_sane_error(chunk.max_error) || chunk.length > (1ull << 40) ||
        splits > added - sum || inserted > added - sum - splits ||
        splits + inserted > most_new_vertices(chunk.length)) {
      return bad("impossible chunk of level {}", {level});
    }
    sum += splits + inserted;
    chunk.splits = static_cast<std::uint32_t>(splits);
    chunk.inserted = static_cast<std::uint32_t>(inserted);
    std::copy(digest.begin(), digest.end(), chunk.sha256.begin());
    m.file_bytes += chunk.length;
    m.chunks.push_back(chunk);
  }
  if (sum == added) return {};
  return bad("the chunks of level {} do not make up its vertices", {level});
}

Expected<void> read_chunks(ByteReader& in, Manifest& m) {
  m.file_bytes = place_head(m);
  for (std::uint32_t level = 1; level < m.levels.size(); ++level) {
    if (auto ok = read_level_chunks(in, level, m); !ok) return ok;
  }
  place_tail(m);
  return {};
}

void write_frame(ByteWriter& out, const Manifest& m) {
  out.u8(static_cast<std::uint8_t>(m.lattice.bits));
  out.f64(m.lattice.origin.x);
  out.f64(m.lattice.origin.y);
  out.f64(m.lattice.origin.z);
  out.f64(m.lattice.step);
  out.u8(static_cast<std::uint8_t>(m.unit.size()));
  out.bytes({reinterpret_cast<const std::uint8_t*>(m.unit.data()), m.unit.size()});
  out.varint(m.loops);
}

Expected<void> read_frame(ByteReader& in, const Limits& limits, Manifest& m) {
  m.lattice.bits = in.u8();
  m.lattice.origin.x = in.f64();
  m.lattice.origin.y = in.f64();
  m.lattice.origin.z = in.f64();
  m.lattice.step = in.f64();
  if (m.lattice.bits < kMinBits || m.lattice.bits > kMaxBits) return bad("lattice bits");
  const bool finite = std::isfinite(m.lattice.origin.x) && std::isfinite(m.lattice.origin.y) &&
                      std::isfinite(m.lattice.origin.z);
  if (!finite || !(m.lattice.step > 0 && m.lattice.step < kMostStep))
    return bad("lattice transform");
  const std::size_t unit = in.u8();
  if (unit > kMaxUnitBytes) return bad("unit name too long");
  const auto name = in.bytes(unit);
  if (!std::all_of(name.begin(), name.end(), [](auto c) { return c >= 0x20 && c < 0x7F; })) {
    return bad("unit name is not printable ASCII");
  }
  for (const std::uint8_t c : name)
    m.unit += static_cast<char>(c);
  const std::uint64_t loops = in.varint();
  if (loops > limits.vertices / 3) return bad("impossible number of boundary loops");
  m.loops = static_cast<std::uint32_t>(loops);
  return {};
}

Expected<void> read_body(ByteReader& in, const Limits& limits, std::uint64_t features,
                         Manifest& m) {
  if (auto ok = read_frame(in, limits, m); !ok) return ok;
  if (auto ok = read_levels(in, limits, m); !ok) return ok;
  if (auto ok = read_regions(in, limits, m); !ok) return ok;
  m.base_length = in.varint();
  if (!read_hash(in, m.base_sha256) || m.base_length > (1ull << 40))
    return bad("it ends before the base mesh's record");
  if ((features & kFeatureTexture) != 0) {
    if (auto ok = read_texture(in, m.texture); !ok) return ok;
  }
  if ((features & kFeatureOptional) != 0) {
    if (auto ok = read_optional_blocks(in, m); !ok) return ok;
  }
  if (auto ok = read_chunks(in, m); !ok) return ok;
  if (!in.is_ok()) return bad("it ends early");
  return {};
}

// Whether the last 32 bytes of the header are the SHA-256 of all header bytes before them.
bool is_sealed(std::span<const std::uint8_t> header) {
  const Sha256 hash = sha256(header.first(header.size() - kHashBytes));
  return std::equal(hash.begin(), hash.end(), header.last(kHashBytes).begin());
}

}  // namespace

std::uint64_t TextureInfo::bytes() const {
  std::uint64_t bytes = atlas_length;
  for (const PictureInfo& picture : pictures)
    bytes += picture.length;
  return bytes;
}

std::uint64_t Manifest::optional_bytes() const {
  std::uint64_t bytes = 0;
  for (const OptionalBlock& block : optional_blocks)
    bytes += block.length;
  return bytes;
}

std::uint64_t Manifest::head_bytes() const {
  std::uint64_t bytes = base_offset + base_length + texture.atlas_length;
  for (std::uint32_t i = 0; i < texture.in_head; ++i)
    bytes += texture.pictures[i].length;
  return bytes;
}

std::uint64_t Manifest::cumulative_bytes(std::uint32_t level) const {
  std::uint64_t bytes = head_bytes();
  for (const ChunkInfo& chunk : chunks) {
    if (chunk.level <= level) bytes += chunk.length;
  }
  return bytes;
}

std::size_t Manifest::find_chunk(std::uint32_t level, std::uint32_t leaf) const {
  const auto is_behind = [&](std::uint32_t wanted, const ChunkInfo& chunk) {
    return chunk.level != level ? chunk.level > level : chunk.region > wanted;
  };
  const auto behind = std::upper_bound(chunks.begin(), chunks.end(), leaf, is_behind);
  if (behind == chunks.begin() || std::prev(behind)->level != level || leaf >= tree.leaves()) {
    return chunks.size();
  }
  return static_cast<std::size_t>(std::prev(behind) - chunks.begin());
}

// `prefix` holds the signature (8 bytes), the major version (2), the minor version (2) and the
// header length (4).
Expected<std::uint64_t> header_bytes(std::span<const std::uint8_t> prefix) {
  ByteReader in(prefix);
  const auto magic = in.bytes(kMagic.size());
  const std::uint16_t major = in.u16();
  in.u16();  // the minor version; a reader accepts all minor versions
  const std::uint64_t length = in.u32();
  if (!in.is_ok() || !std::equal(magic.begin(), magic.end(), kMagic.begin())) {
    return fail(ErrorCode::kBadInput,
                "not a .pmesh file (its first bytes are not the signature); make one of a mesh "
                "with vitrine build");
  }
  if (major != kFormatMajor) {
    return fail(ErrorCode::kUnsupported,
                fill_in("the file has format version {}, this program reads version {}; update it",
                        {major, kFormatMajor}));
  }
  if (length < kHeaderPrefix + kHashBytes) return bad("its length is impossible");
  return length;
}

Expected<Manifest> parse_header(std::span<const std::uint8_t> bytes, const Limits& limits) {
  auto length = header_bytes(bytes.first(std::min(bytes.size(), kHeaderPrefix)));
  if (!length) return tl::unexpected(length.error());
  if (*length > limits.header_bytes || *length > bytes.size()) {
    return bad("it is cut off ({} of {} bytes)", {bytes.size(), *length});
  }
  if (!is_sealed(bytes.first(*length))) {
    return bad("its SHA-256 is not the one it ends with (a byte has changed)");
  }
  ByteReader in(bytes.subspan(kHeaderPrefix, *length - kHeaderPrefix - kHashBytes));
  Manifest m;
  const std::uint64_t features = in.varint();
  if ((features & ~kKnownFeatures) != 0) {
    return fail(ErrorCode::kUnsupported,
                fill_in("the file needs feature bits {} that this program does not know; update it",
                        {features & ~kKnownFeatures}));
  }
  m.placement = (features & kFeaturePyramid) != 0 ? Placement::kPyramid : Placement::kMidpoint;
  if ((features & kFeatureColours) != 0) m.attributes.push_back(Semantic::kColour);
  m.has_insertions = (features & kFeatureInsertions) != 0;
  m.base_offset = *length;
  const bool is_textured = (features & kFeatureTexture) != 0;
  if (is_textured && m.has_insertions) {
    return bad("a textured model inserts components, which have no texture coordinates");
  }
  if (auto ok = read_body(in, limits, features, m); !ok) return tl::unexpected(ok.error());
  if (in.left() != 0) return bad("it holds bytes that belong to nothing");
  return m;
}

bool is_pmesh(std::span<const std::uint8_t> bytes) {
  const auto length = header_bytes(bytes.first(std::min(bytes.size(), kHeaderPrefix)));
  return length.has_value() || length.error().code == ErrorCode::kUnsupported;
}

std::vector<std::uint8_t> write_header(Manifest& m) {
  ByteWriter body;
  body.varint((m.placement == Placement::kPyramid ? kFeaturePyramid : 0) |
              (m.has(Semantic::kColour) ? kFeatureColours : 0) |
              (m.has_insertions ? kFeatureInsertions : 0) |
              (m.texture.empty() ? 0 : kFeatureTexture) |
              (m.optional_blocks.empty() ? 0 : kFeatureOptional));
  write_frame(body, m);
  write_levels(body, m);
  write_regions(body, m);
  body.varint(m.base_length);
  body.bytes(m.base_sha256);
  write_texture(body, m.texture);
  write_optional_blocks(body, m);
  write_chunks(body, m);

  ByteWriter out;
  out.bytes(kMagic);
  out.u16(kFormatMajor);
  out.u16(kFormatMinor);
  out.u32(static_cast<std::uint32_t>(kHeaderPrefix + body.size() + kHashBytes));
  out.bytes(body.take());
  std::vector<std::uint8_t> header = out.take();
  const Sha256 hash = sha256(header);
  header.insert(header.end(), hash.begin(), hash.end());

  m.base_offset = header.size();
  m.file_bytes = place_head(m);
  for (ChunkInfo& chunk : m.chunks)
    chunk.offset = m.file_bytes, m.file_bytes += chunk.length;
  place_tail(m);
  return header;
}

}  // namespace vitrine::inline codec
