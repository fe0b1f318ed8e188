// SPDX-License-Identifier: Apache-2.0
#include "codec/build/open_model.h"

#include <fmt/core.h>

#include "codec/base/base_decoder.h"
#include "codec/coding/atlas_coder.h"

namespace vitrine::inline codec {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

Expected<ByteSpan> checked_range(ByteSpan pmesh, std::uint64_t offset, std::uint64_t length,
                                 const Sha256& name, const std::string& what,
                                 std::string_view next_step) {
  if (offset > pmesh.size() || length > pmesh.size() - offset) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the file is cut off at byte {}, before the end of {}; {}",
                            pmesh.size(), what, next_step));
  }
  const ByteSpan bytes = pmesh.subspan(offset, length);
  if (sha256(bytes) == name) return bytes;
  return fail(ErrorCode::kBadInput, fmt::format("{} at byte {} is damaged (SHA-256 differs); fetch "
                                                "the file again",
                                                what, offset));
}

}  // namespace

Expected<Refiner> open_model(ByteSpan pmesh) {
  auto manifest = parse_header(pmesh);
  if (!manifest) return tl::unexpected(manifest.error());
  const auto bytes = checked_range(pmesh, manifest->base_offset, manifest->base_length,
                                   manifest->base_sha256, "the base mesh", "fetch it again");
  if (!bytes) return tl::unexpected(bytes.error());
  auto base = decode_base(*bytes, *manifest);
  if (!base) return tl::unexpected(base.error());
  if (const TextureInfo& texture = manifest->texture; !texture.empty()) {
    const auto coded = checked_range(pmesh, texture.atlas_offset, texture.atlas_length,
                                     texture.atlas_sha256, "the atlas", "fetch it again");
    if (!coded) return tl::unexpected(coded.error());
    auto atlas = decode_atlas(*coded, *base);
    if (!atlas) return tl::unexpected(atlas.error());
    base->atlas = std::move(*atlas);
  }
  return Refiner::start(std::move(*manifest), *base);
}

Expected<ByteSpan> picture_of(const Manifest& manifest, ByteSpan pmesh, std::size_t i) {
  const PictureInfo& picture = manifest.texture.pictures[i];
  return checked_range(pmesh, picture.offset, picture.length, picture.sha256,
                       fmt::format("picture {} of the texture", i), "fetch it again");
}

Expected<ByteSpan> optional_block(const OptionalBlock& block, ByteSpan pmesh) {
  return checked_range(pmesh, block.offset, block.length, block.sha256, "an optional block",
                       "fetch it again");
}

ChunkReader chunks_of(const Manifest& manifest, ByteSpan pmesh) {
  return [&manifest, pmesh](std::size_t index) -> Expected<ByteSpan> {
    const ChunkInfo& c = manifest.chunks[index];
    return checked_range(pmesh, c.offset, c.length, c.sha256,
                         fmt::format("the chunk of level {}, region {}", c.level, c.region),
                         "fetch it again or ask for a coarser level");
  };
}

}  // namespace vitrine::inline codec
