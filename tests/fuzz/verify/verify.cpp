// SPDX-License-Identifier: Apache-2.0
// Runs the checks of `vitrine verify` on hostile headers and chunks. The seeds are those of the
// decode fuzzer, in which a raw base mesh replaces the Draco buffer. This program encodes the base
// mesh with Draco and corrects every checksum, so that no input is refused because of a checksum.
// It sets no memory bound, because the decode fuzzer bounds the memory of decoding.
#include "../checks.h"
#include "../decode/raw_base.h"
#include "codec/base/base_encoder.h"
#include "codec/build/verify_model.h"
#include "codec/refine/refiner.h"
#include "support/sealed.h"

namespace vitrine {
namespace {

using fuzz::part;

constexpr Limits kLimits = {.vertices = 5'000, .faces = 10'000};

// Returns the file with a Draco base mesh and correct checksums. Returns an empty file if the base
// mesh cannot be encoded.
std::vector<std::uint8_t> with_draco_base(std::span<const std::uint8_t> bytes) {
  auto manifest = parse_header(bytes, kLimits);
  if (!manifest) return {};
  const BaseMesh raw =
      fuzz::read_raw_base(part(bytes, manifest->base_offset, manifest->base_length), *manifest);
  if (!Refiner::start(*manifest, raw)) return {};
  const auto base = encode_base(raw);
  if (!base) return {};
  manifest->base_length = base->bytes.size();
  manifest->base_sha256 = sha256(base->bytes);
  std::vector<std::uint8_t> body = base->bytes;
  const auto move = [&](std::uint64_t offset, std::uint64_t& length, Sha256& name) {
    const auto data = part(bytes, offset, length);
    length = data.size();
    name = sha256(data);
    body.insert(body.end(), data.begin(), data.end());
  };
  TextureInfo& texture = manifest->texture;
  move(texture.atlas_offset, texture.atlas_length, texture.atlas_sha256);
  for (std::size_t i = 0; i < texture.in_head; ++i)
    move(texture.pictures[i].offset, texture.pictures[i].length, texture.pictures[i].sha256);
  for (ChunkInfo& chunk : manifest->chunks)
    move(chunk.offset, chunk.length, chunk.sha256);
  for (std::size_t i = texture.in_head; i < texture.pictures.size(); ++i)
    move(texture.pictures[i].offset, texture.pictures[i].length, texture.pictures[i].sha256);
  for (OptionalBlock& block : manifest->optional_blocks)
    move(block.offset, block.length, block.sha256);
  std::vector<std::uint8_t> file = write_header(*manifest);
  file.insert(file.end(), body.begin(), body.end());
  return file;
}

}  // namespace
}  // namespace vitrine

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = vitrine::with_draco_base(vitrine::test::sealed({data, size}));
  if (file.empty()) return 0;
  const auto none = [](std::string_view, double) {};
  const auto verified = vitrine::verify_model(file, std::nullopt, none);
  vitrine::fuzz::require(verified || !verified.error().message.empty());
  return 0;
}
