// SPDX-License-Identifier: Apache-2.0
#include "server/api/decoded_model.h"

#include "codec/base/base_decoder.h"
#include "codec/build/refine.h"

namespace vitrine::server {

Expected<TriangleMesh> decoded_model(const PublishedModel& model, const Want& want) {
  const auto base_bytes = model.read(model.base());
  if (!base_bytes) return tl::unexpected(base_bytes.error());
  const auto base = decode_base(*base_bytes, model.manifest());
  if (!base) return tl::unexpected(base.error());
  auto refiner = Refiner::start(model.manifest(), *base);
  if (!refiner) return tl::unexpected(refiner.error());
  std::vector<std::uint8_t> bytes;  // bytes of the chunk that was read last
  const auto read = [&](std::size_t chunk) -> Expected<std::span<const std::uint8_t>> {
    auto fresh = model.read(model.chunk(chunk));
    if (!fresh) return tl::unexpected(fresh.error());
    bytes = std::move(*fresh);
    return bytes;
  };
  if (const auto refined = refine(*refiner, want, read); !refined)
    return tl::unexpected(refined.error());
  return refiner->display_mesh();
}

}  // namespace vitrine::server
