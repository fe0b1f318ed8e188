// SPDX-License-Identifier: Apache-2.0
#include "codec/build/open_model.h"

#include <fmt/core.h>

#include "codec/base/base_decoder.h"

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
  const auto base = decode_base(*bytes, *manifest);
  if (!base) return tl::unexpected(base.error());
  return Refiner::start(std::move(*manifest), *base);
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
