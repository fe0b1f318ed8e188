// SPDX-License-Identifier: Apache-2.0
#include "codec/build/originals.h"

#include <algorithm>
#include <array>

#include "codec/build/open_model.h"
#include "codec/build/source_coordinates.h"
#include "codec/build/source_materials.h"
#include "codec/core/byte_cursor.h"

namespace vitrine::inline codec {
namespace {

Unexpected damaged() {
  return fail(ErrorCode::kBadInput, "the originals are damaged; fetch the file again");
}

// Returns a bit mask of the sets of coordinates that the texturing has.
std::uint8_t sets_of(const Texturing& texturing) {
  std::uint8_t sets = 0;
  for (std::size_t set = 0; set < kCoordinateSets; ++set)
    sets |= static_cast<std::uint8_t>((texturing.coordinates[set].empty() ? 0u : 1u) << set);
  return sets;
}

// Returns the texturing without the bytes of its pictures.
Texturing without_pictures(const Texturing& texturing) {
  Texturing out{.materials = texturing.materials,
                .pictures = {},
                .face_materials = texturing.face_materials,
                .coordinates = texturing.coordinates};
  return out;
}

std::vector<std::uint8_t> description_of(std::span<const Triangle> faces, std::uint32_t vertices,
                                         const Texturing& texturing) {
  ByteWriter out;
  write_source_materials(out, texturing);
  out.u8(sets_of(texturing));
  const auto mesh = Connectivity::close(vertices, faces);
  if (!mesh) return {};
  out.bytes(encode_source_coordinates(*mesh, static_cast<std::uint32_t>(faces.size()),
                                      without_pictures(texturing)));
  return out.take();
}

Expected<Texturing> read_description(std::span<const std::uint8_t> bytes, const LatticeMesh& mesh) {
  ByteReader in(bytes);
  auto texturing = read_source_materials(in);
  if (!texturing) return texturing;
  const std::uint8_t sets = in.u8();
  if (!in.is_ok() || (sets >> kCoordinateSets) != 0) return damaged();
  std::array<bool, kCoordinateSets> has_set{};
  for (std::size_t set = 0; set < kCoordinateSets; ++set)
    has_set[set] = (sets >> set & 1u) != 0;
  bool has_all = true;
  for (const Material& material : texturing->materials)
    for_each_map(material,
                 [&](const TextureMap& map) { has_all = has_all && has_set[map.coordinates]; });
  if (!has_all) return damaged();
  const auto faces =
      Connectivity::close(static_cast<std::uint32_t>(mesh.positions.size()), mesh.faces);
  if (!faces) return tl::unexpected(faces.error());
  const auto decoded =
      decode_source_coordinates(in.bytes(in.left()), *faces,
                                static_cast<std::uint32_t>(mesh.faces.size()), has_set, *texturing);
  if (!decoded) return tl::unexpected(decoded.error());
  return texturing;
}

void add_block(OptionalKind kind, std::span<const std::uint8_t> bytes, Manifest& manifest,
               std::vector<std::uint8_t>& body) {
  manifest.optional_blocks.push_back(
      {.kind = static_cast<std::uint64_t>(kind), .length = bytes.size(), .sha256 = sha256(bytes)});
  body.insert(body.end(), bytes.begin(), bytes.end());
}

bool is_of(const OptionalBlock& block, OptionalKind kind) {
  return block.kind == static_cast<std::uint64_t>(kind);
}

const OptionalBlock* description_in(const Manifest& manifest) {
  for (const OptionalBlock& block : manifest.optional_blocks) {
    if (is_of(block, OptionalKind::kSource)) return &block;
  }
  return nullptr;
}

}  // namespace

bool add_originals(std::span<const Triangle> faces, std::uint32_t vertices,
                   const Texturing& texturing, Manifest& manifest,
                   std::vector<std::uint8_t>& body) {
  if (texturing.pictures.size() >= kMaxOptionalBlocks) return false;
  const auto description = description_of(faces, vertices, texturing);
  if (description.empty()) return false;
  add_block(OptionalKind::kSource, description, manifest, body);
  for (const EncodedPicture& picture : texturing.pictures)
    add_block(OptionalKind::kSourcePicture, picture.bytes, manifest, body);
  return true;
}

bool has_originals(const Manifest& manifest) {
  return description_in(manifest) != nullptr;
}

std::uint64_t originals_bytes(const Manifest& manifest) {
  std::uint64_t bytes = 0;
  for (const OptionalBlock& block : manifest.optional_blocks) {
    if (is_of(block, OptionalKind::kSource) || is_of(block, OptionalKind::kSourcePicture))
      bytes += block.length;
  }
  return bytes;
}

bool have_same_materials(const Texturing& a, const Texturing& b) {
  ByteWriter of_a, of_b;
  write_source_materials(of_a, a);
  write_source_materials(of_b, b);
  return of_a.take() == of_b.take() &&
         std::ranges::equal(a.pictures, b.pictures, {}, &EncodedPicture::bytes,
                            &EncodedPicture::bytes);
}

Expected<Texturing> originals_of(const Refiner& refiner, std::span<const std::uint8_t> pmesh) {
  const Manifest& manifest = refiner.manifest();
  const OptionalBlock* description = description_in(manifest);
  if (description == nullptr) {
    return fail(ErrorCode::kState,
                "the file has no originals of a texture; build it from a textured mesh");
  }
  if (refiner.face_count() != manifest.levels.back().faces)
    return fail(ErrorCode::kState,
                "the originals belong to the finest level; leave out the detail");
  const auto bytes = optional_block(*description, pmesh);
  if (!bytes) return tl::unexpected(bytes.error());
  auto texturing = read_description(*bytes, refiner.lattice_mesh());
  if (!texturing) return texturing;
  std::size_t filled = 0;
  for (const OptionalBlock& block : manifest.optional_blocks) {
    if (!is_of(block, OptionalKind::kSourcePicture)) continue;
    if (filled == texturing->pictures.size()) return damaged();
    const auto picture = optional_block(block, pmesh);
    if (!picture) return tl::unexpected(picture.error());
    texturing->pictures[filled++].bytes.assign(picture->begin(), picture->end());
  }
  if (filled != texturing->pictures.size()) return damaged();
  return texturing;
}

}  // namespace vitrine::inline codec
